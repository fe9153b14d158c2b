// SPDX-License-Identifier: BSD-3-Clause
// Copies of particles share memory: results must equal those of plain copies.
#include "common/random/random.hpp"
#include "slam/core/gmapping/hit_map.hpp"
#include "slam/core/gmapping/published_map.hpp"
#include "slam/core/resampling/particle_set.hpp"
#include "support/plain_hit_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <utility>

namespace waymark {
namespace {

const GridFrame kFrame = GridFrame::centred_on_map_origin(0.05);
constexpr double kUsableRange_m = 2.5;
constexpr double kOccupied = 0.25;

std::size_t any_of(std::size_t count, Random& random) {
  return static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
}

template <class Cell>
std::size_t num_touched(const SparseTile<Cell>& tile) {
  std::size_t count = 0;
  for (std::size_t offset = 0; offset < kTileCells; ++offset)
    count += tile.is_touched(offset) ? 1 : 0;
  return count;
}

/// Tiles of `map` that it does not share with `other`.
int num_unshared_tiles(const HitMap& map, const HitMap& other) {
  int count = 0;
  map.for_each_tile(
      [&](TileIndex index, const auto& tile) { count += other.tile(index) != &tile ? 1 : 0; });
  return count;
}

TEST(SparseTile, ReadsLikeAPlainArrayOfCells) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random{seed};
    SparseTile<int> tile;
    std::map<std::size_t, int> plain;
    for (int i = 0; i < 600; ++i) {
      const std::size_t offset = any_of(kTileCells, random);
      tile[offset] += i;
      plain[offset] += i;
    }
    EXPECT_EQ(num_touched(tile), plain.size());
    for (std::size_t offset = 0; offset < kTileCells; ++offset) {
      EXPECT_EQ(tile.is_touched(offset), plain.contains(offset));
      EXPECT_EQ(std::as_const(tile)[offset], plain.contains(offset) ? plain[offset] : 0);
    }
    for (int i = 0; i < 200; ++i) {
      const int row = static_cast<int>(any_of(kTileSize, random));
      const int low = static_cast<int>(any_of(kTileSize, random));
      const int high =
          low + static_cast<int>(any_of(static_cast<std::size_t>(kTileSize - low), random));
      std::map<std::size_t, int> visited;
      tile.visit_row(row, low, high, [&](int column, int cell) {
        visited[static_cast<std::size_t>(row * kTileSize + column)] = cell;
      });
      const auto first = plain.lower_bound(static_cast<std::size_t>(row * kTileSize + low));
      const auto last = plain.upper_bound(static_cast<std::size_t>(row * kTileSize + high));
      EXPECT_EQ(visited, (std::map<std::size_t, int>{first, last}));
    }
  }
}

TEST(SparseTile, ASquareOfTouchedCellsIsVisitedOverTheTilesBorders) {
  Random random{21};
  TileMap<int, SparseTile<int>> cells;
  std::map<CellIndex, int> plain;
  const auto any_cell = [&] {
    return CellIndex{static_cast<int>(any_of(100, random)) - 50,
                     static_cast<int>(any_of(100, random)) - 50};
  };
  for (int i = 1; i <= 2000; ++i) {
    const CellIndex cell = any_cell();
    cells.edit(cell) = i;
    plain[cell] = i;
  }
  for (int i = 0; i < 500; ++i) {
    const CellIndex centre = any_cell();
    const int reach = static_cast<int>(any_of(6, random));
    std::map<CellIndex, int> visited;
    visit_touched_around(cells, centre, reach,
                         [&](CellIndex cell, int value) { visited[cell] = value; });
    std::map<CellIndex, int> inside;
    for (const auto& [cell, value] : plain) {
      if (std::abs(cell.x - centre.x) <= reach && std::abs(cell.y - centre.y) <= reach)
        inside[cell] = value;
    }
    EXPECT_EQ(visited, inside);
  }
}

TEST(HitMap, SharedMapsReadLikePlainCopies) {
  struct Particle {
    HitMap map{};
    testing::PlainHitMap plain{kFrame};
  };

  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Random random{seed};
    std::vector<Particle> particles(6);
    for (int generation = 0; generation < 25; ++generation) {
      std::vector<Particle> children;
      for (std::size_t i = 0; i < particles.size(); ++i)
        children.push_back(particles[any_of(particles.size(), random)]);
      particles = std::move(children);
      for (Particle& particle : particles) {
        for (int i = 0; i < 30; ++i) {
          const Eigen::Vector2d point{random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0)};
          add_hit(kFrame, point, particle.map);
          particle.plain.add(point);
        }
      }
    }
    for (const Particle& particle : particles) {
      std::size_t touched = 0;
      particle.map.for_each_tile(
          [&](TileIndex, const auto& tile) { touched += num_touched(tile); });
      EXPECT_EQ(touched, particle.plain.points().size());
      for (const auto& [cell, points] : particle.plain.points()) {
        const HitCell& hit = particle.map[cell];
        EXPECT_EQ(hit.hits, points.size());
        const Eigen::Vector2d mean =
            kFrame.centre_of(cell) + kFrame.resolution_m * Eigen::Vector2d{hit.mean_x, hit.mean_y};
        EXPECT_LT((mean - particle.plain.mean_of(cell)).norm(), 1e-6);
      }
    }
  }
}

TEST(HitMap, ResamplingCopiesNoCells) {
  HitMap parent;
  Random random{1};
  for (int i = 0; i < 500; ++i)
    add_hit(kFrame, {random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0)}, parent);
  const HitMap child = parent;
  EXPECT_EQ(num_unshared_tiles(child, parent), 0);
  HitMap other = parent;
  add_hit(kFrame, {0.0, 0.0}, other);
  EXPECT_EQ(num_unshared_tiles(other, parent), 1);
}

/// The map along a trajectory of which a plain copy was kept, drawn from its first scan on.
GridMap drawn_anew(const std::vector<std::pair<Se2, std::shared_ptr<const StoredScan>>>& way) {
  GridMap map{kFrame, {}, {}};
  for (const auto& [pose, scan] : way)
    draw_scan(*scan, pose, kUsableRange_m, map);
  return map;
}

void expect_decided(const GridMap& published, const GridMap& drawn) {
  const auto expect_tile = [&](TileIndex tile, const auto&) {
    for (std::size_t offset = 0; offset < kTileCells; ++offset) {
      const CellIndex index = cell_at(tile, offset);
      const OccupancyCell& cell = drawn.occupancy[index];
      const OccupancyCell decided{cell.occupancy() > kOccupied ? 1U : 0U,
                                  cell.is_mapped() ? 1U : 0U};
      ASSERT_EQ(published.occupancy[index], decided) << index.x << ' ' << index.y;
    }
  };
  drawn.occupancy.for_each_tile(expect_tile);
  published.occupancy.for_each_tile(expect_tile);
}

std::shared_ptr<const StoredScan> random_scan(Random& random) {
  auto scan = std::make_shared<StoredScan>();
  for (int i = 0; i < 12; ++i) {
    const double angle_rad = random.uniform(-3.0, 3.0);
    const double range_m = random.uniform(0.2, 3.0);
    scan->push_back({i, Eigen::Vector2d::Zero(),
                     range_m * Eigen::Vector2d{std::cos(angle_rad), std::sin(angle_rad)}, range_m});
  }
  return scan;
}

TEST(PublishedMap, EqualsAMapDrawnFromScratch) {
  struct Particle {
    Trajectory trajectory{};
    std::vector<std::pair<Se2, std::shared_ptr<const StoredScan>>> way{};
  };

  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Random random{seed};
    PublishedMap published{kFrame, kUsableRange_m, kOccupied};
    std::vector<Particle> particles(4);
    for (int update = 0; update < 40; ++update) {
      const bool resamples = random.uniform() < 0.3;
      if (resamples) {
        std::vector<Particle> children;
        for (std::size_t i = 0; i < particles.size(); ++i)
          children.push_back(particles[any_of(particles.size(), random)]);
        particles = std::move(children);
      }
      const auto scan = random_scan(random);
      std::vector<Trajectory> trajectories;
      for (Particle& particle : particles) {
        const Se2 pose{random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0),
                       random.uniform(-3.0, 3.0)};
        particle.trajectory = std::make_shared<TrajectoryNode>(pose, scan, particle.trajectory);
        particle.way.emplace_back(pose, scan);
        trajectories.push_back(particle.trajectory);
      }
      if (resamples) {
        if (const Trajectory trunk = common_ancestor(trajectories)) published.finalise(trunk);
      }
      if (random.uniform() < 0.6) {
        const Particle& best = particles[any_of(particles.size(), random)];
        expect_decided(published.along(best.trajectory), drawn_anew(best.way));
      }
    }
  }
}

TEST(PublishedMap, MemoryIsBoundedAsParticlesShareTheirPast) {
  // Ever one survivor: what is behind it must be gone, however long the run.
  PublishedMap published{kFrame, kUsableRange_m, kOccupied};
  Random random{1};
  std::vector<std::weak_ptr<const StoredScan>> scans;
  std::vector<std::weak_ptr<TrajectoryNode>> nodes;
  std::vector<Trajectory> particles(5);
  for (int update = 0; update < 50; ++update) {
    std::fill(particles.begin(), particles.end(), particles[any_of(particles.size(), random)]);
    const auto scan = random_scan(random);
    scans.push_back(scan);
    for (Trajectory& particle : particles) {
      particle = std::make_shared<TrajectoryNode>(Se2{}, scan, particle);
      nodes.push_back(particle);
    }
    if (const Trajectory trunk = common_ancestor(particles)) published.finalise(trunk);
    published.along(particles[2]);
  }
  const auto alive = [](const auto& all) {
    return std::count_if(all.begin(), all.end(), [](const auto& one) { return !one.expired(); });
  };
  EXPECT_LE(alive(scans), 2);
  EXPECT_LE(alive(nodes), 2 * 5 + 1);
}

TEST(Resampling, TheMeanNumberOfCopiesIsProportionalToTheWeight) {
  const std::vector<double> weights{0.02, 0.5, 0.18, 0.0, 0.3};
  constexpr std::uint64_t kRounds = 20000;
  std::vector<double> copies(weights.size());
  for (std::uint64_t round = 0; round < kRounds; ++round) {
    ParticleSet<std::size_t> particles{weights.size(), 0};
    for (std::size_t i = 0; i < weights.size(); ++i) {
      particles.state(i) = i;
      particles.add_log_weight(i, std::log(weights[i]));
    }
    particles.normalise();
    Random random{1, round};
    ASSERT_FALSE(particles.resample_if_needed(1.0, random).empty());
    for (std::size_t i = 0; i < weights.size(); ++i)
      copies[particles.state(i)] += 1.0 / kRounds;
  }
  // Systematic: a particle has floor or ceil of N w copies, so the standard error is at most
  // 0.5 / sqrt(rounds) = 0.0035.
  for (std::size_t i = 0; i < weights.size(); ++i)
    EXPECT_NEAR(copies[i], 5.0 * weights[i], 0.014) << i;
}

}  // namespace
}  // namespace waymark
