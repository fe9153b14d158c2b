// SPDX-License-Identifier: BSD-3-Clause
#include "drawn_drive/building.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace waymark::drawn {
namespace {

using Eigen::Vector2d;

constexpr double kMargin_m = 8.0;  // of solid ground about a building of corridors
constexpr double kWall_m = 0.15;
constexpr double kDoor_m = 0.95;
constexpr double kRecess_m = 0.1;  // of a door that is closed
constexpr double kKeptClear_m = 1.3;

struct Corridors {
  int across{1};
  int along{1};
  double least_block_m{12.0};
  double most_block_m{22.0};
  double width_m{2.0};
  double open_doors{0.7};  ///< share
  int clutter{4};          ///< things in each room
};

Vector2d between(const Vector2d& low, const Vector2d& high, Random& random) {
  return {random.uniform(low.x(), high.x()), random.uniform(low.y(), high.y())};
}

void scatter(Building& building, const Vector2d& low, const Vector2d& high, int things,
             Random& random) {
  if ((high - low).minCoeff() <= 0.0) return;
  for (int i = 0; i < things; ++i) {
    const Vector2d place = between(low, high, random);
    if (random.uniform() < 0.5)
      building.fill(place, place + between({0.2, 0.2}, {1.2, 0.9}, random));
    else
      building.fill_disc(place, random.uniform(0.05, 0.3));
  }
}

/// One row of rooms behind a wall. `to_map` turns (along the wall, into the block) into the map.
template <class ToMap>
void add_rooms(Building& building, double length_m, double depth_m, const Corridors& plan,
               Random& random, ToMap to_map) {
  const auto carve = [&](double along, double into, double along_end, double into_end) {
    const Vector2d a = to_map(along, into);
    const Vector2d b = to_map(along_end, into_end);
    building.carve(a.cwiseMin(b), a.cwiseMax(b));
  };
  double start = 0.2;
  while (start + 2.8 < length_m) {
    const double width = std::min(random.uniform(2.8, 7.0), length_m - start - 0.2);
    const double depth = random.uniform(2.8, depth_m);
    const double door = start + random.uniform(0.2, std::max(0.25, width - 1.4));
    if (random.uniform() < plan.open_doors) {
      carve(start, kWall_m, start + width - kWall_m, depth);
      const Vector2d a = to_map(start + 0.2, kWall_m + kKeptClear_m);
      const Vector2d b = to_map(start + width - 0.5, depth - 0.4);
      scatter(building, a.cwiseMin(b), a.cwiseMax(b), plan.clutter, random);
      carve(door, -kWall_m, door + kDoor_m, kWall_m + kKeptClear_m);
    } else {
      carve(door, -kWall_m, door + kDoor_m, kRecess_m);
    }
    start += width;
  }
}

void add_block(Building& building, const Vector2d& low, const Vector2d& high, const Corridors& plan,
               Random& random) {
  const Vector2d size = high - low;
  const double depth = std::min(6.0, 0.5 * (size.minCoeff() - 1.0));
  if (depth < 3.0) return;
  add_rooms(building, size.x(), depth, plan, random, [&](double along, double into) {
    return Vector2d{low.x() + along, low.y() + into};
  });
  add_rooms(building, size.x(), depth, plan, random, [&](double along, double into) {
    return Vector2d{low.x() + along, high.y() - into};
  });
  const double side = size.y() - 2.0 * depth;
  add_rooms(building, side, depth, plan, random, [&](double along, double into) {
    return Vector2d{low.x() + into, low.y() + depth + along};
  });
  add_rooms(building, side, depth, plan, random, [&](double along, double into) {
    return Vector2d{high.x() - into, low.y() + depth + along};
  });
}

Building draw_corridors(const Corridors& plan, Random& random) {
  const auto lines = [&](int blocks) {
    std::vector<double> at{kMargin_m};
    for (int i = 0; i < blocks; ++i)
      at.push_back(at.back() + plan.width_m +
                   random.uniform(plan.least_block_m, plan.most_block_m));
    return at;
  };
  const std::vector<double> xs = lines(plan.across);
  const std::vector<double> ys = lines(plan.along);
  const Vector2d end{xs.back() + plan.width_m, ys.back() + plan.width_m};
  Building building{end.x() + kMargin_m, end.y() + kMargin_m};
  for (const double x : xs)
    building.carve({x, ys.front()}, {x + plan.width_m, end.y()});
  for (const double y : ys)
    building.carve({xs.front(), y}, {end.x(), y + plan.width_m});
  for (std::size_t i = 0; i + 1 < xs.size(); ++i)
    for (std::size_t k = 0; k + 1 < ys.size(); ++k)
      add_block(building, {xs[i] + plan.width_m, ys[k] + plan.width_m}, {xs[i + 1], ys[k + 1]},
                plan, random);
  return building;
}

Building draw_hall(Random& random) {
  Building hall{60.0, 45.0};
  hall.carve({2.0, 2.0}, {58.0, 43.0});
  for (int i = 0; i < 30; ++i) {
    const Vector2d place = between({4.0, 4.0}, {56.0, 41.0}, random);
    if (random.uniform() < 0.5)
      hall.fill(place, place + between({0.5, 0.5}, {3.0, 3.0}, random));
    else
      hall.fill_disc(place, 0.3);
  }
  scatter(hall, {3.0, 3.0}, {57.0, 42.0}, 30, random);
  return hall;
}

Building draw_outdoors(Random& random) {
  Building ground{160.0, 140.0};
  ground.carve({1.0, 1.0}, {159.0, 139.0});
  for (int i = 0; i < 16; ++i) {
    const Vector2d place = between({5.0, 5.0}, {140.0, 120.0}, random);
    ground.fill(place, place + between({6.0, 6.0}, {25.0, 20.0}, random));
  }
  for (int i = 0; i < 70; ++i) {
    const double radius_m = random.uniform(0.1, 0.5);
    ground.fill_disc(between({3.0, 3.0}, {157.0, 137.0}, random), radius_m);
  }
  scatter(ground, {3.0, 3.0}, {157.0, 137.0}, 60, random);
  return ground;
}

/// Square rooms between thin walls: a random tree of ways through them, and a few loops more.
Building draw_maze(Random& random) {
  constexpr int kRooms = 5;  // on each side
  constexpr double kRoom_m = 1.4;
  constexpr double kThin_m = 0.05;
  constexpr double kMoreDoors = 0.15;  // share of the walls left
  constexpr double kTries = 40.0;      // to open a wall, for each room
  const double side_m = kRooms * kRoom_m;
  Building maze{side_m + 2.0, side_m + 2.0};
  const auto corner = [&](int column, int row) {
    return Vector2d{1.0 + column * kRoom_m, 1.0 + row * kRoom_m};
  };
  const Vector2d room{kRoom_m - kThin_m, kRoom_m - kThin_m};
  std::vector<int> part;  // number of the connected part that a room belongs to
  for (int i = 0; i < kRooms * kRooms; ++i) {
    part.push_back(i);
    const Vector2d low = corner(i % kRooms, i / kRooms);
    maze.carve(low, low + room);
  }
  const auto part_of = [&](int number) {
    return part[static_cast<std::size_t>(number)];
  };
  const auto open = [&](int from, int to) {
    const Vector2d low = corner(from % kRooms, from / kRooms);
    maze.carve(low, corner(to % kRooms, to / kRooms) + room);
    std::replace(part.begin(), part.end(), part_of(to), part_of(from));
  };
  for (int i = 0; i < kTries * kRooms * kRooms; ++i) {
    const int from = static_cast<int>(random.uniform(0.0, kRooms * kRooms));
    const bool across = random.uniform() < 0.5;
    const int to = from + (across ? 1 : kRooms);
    if ((across && to % kRooms == 0) || to >= kRooms * kRooms) continue;
    if (part_of(from) != part_of(to) || random.uniform() < kMoreDoors / kTries) open(from, to);
  }
  return maze;
}

}  // namespace

Building::Building(double width_m, double height_m)
    : columns_{static_cast<int>(width_m / kCell_m)},
      rows_{static_cast<int>(height_m / kCell_m)},
      walls_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), true) {}

std::vector<std::string> Building::kinds() {
  return {"office", "grid", "long", "bare", "hall", "outdoors", "lab", "campus", "maze"};
}

Building Building::draw(const std::string& kind, Random& random) {
  const double width_m = random.uniform(1.8, 3.0);
  if (kind == "office") return draw_corridors({1, 2, 14.0, 20.0, 2.0, 0.9, 10}, random);
  if (kind == "grid") return draw_corridors({2, 2, 12.0, 22.0, width_m, 0.7, 4}, random);
  if (kind == "long") return draw_corridors({2, 1, 60.0, 80.0, width_m, 0.5, 3}, random);
  if (kind == "bare") return draw_corridors({1, 1, 70.0, 90.0, width_m, 0.2, 3}, random);
  if (kind == "hall") return draw_hall(random);
  if (kind == "outdoors") return draw_outdoors(random);
  if (kind == "lab") return draw_corridors({2, 2, 7.5, 10.0, 1.6, 0.9, 6}, random);
  if (kind == "campus") return draw_corridors({3, 2, 30.0, 60.0, width_m, 0.4, 4}, random);
  if (kind == "maze") return draw_maze(random);
  throw std::invalid_argument{"no building of kind '" + kind + "'"};
}

void Building::set(const Vector2d& low_m, const Vector2d& high_m, bool is_wall) {
  const auto cell = [](double at_m, int most) {
    return std::clamp(static_cast<int>(std::lround(at_m / kCell_m)), 0, most);
  };
  for (int row = cell(low_m.y(), rows_); row < cell(high_m.y(), rows_); ++row)
    for (int column = cell(low_m.x(), columns_); column < cell(high_m.x(), columns_); ++column)
      walls_[static_cast<std::size_t>(row * columns_ + column)] = is_wall;
}

void Building::carve(const Vector2d& low_m, const Vector2d& high_m) {
  set(low_m, high_m, false);
}

void Building::fill(const Vector2d& low_m, const Vector2d& high_m) {
  set(low_m, high_m, true);
}

void Building::fill_disc(const Vector2d& centre_m, double radius_m) {
  for (double y = -radius_m; y < radius_m; y += kCell_m) {
    const double half_m = std::sqrt(std::max(0.0, radius_m * radius_m - y * y));
    set(centre_m + Vector2d{-half_m, y}, centre_m + Vector2d{half_m, y + kCell_m}, true);
  }
}

bool Building::is_wall(int column, int row) const {
  return column < 0 || row < 0 || column >= columns_ || row >= rows_ ||
         walls_[static_cast<std::size_t>(row * columns_ + column)];
}

double Building::range_m(const Vector2d& from_m, double direction_rad, double most_m) const {
  const Vector2d direction{std::cos(direction_rad), std::sin(direction_rad)};
  Eigen::Array2i cell = (from_m / kCell_m).array().floor().cast<int>();
  Eigen::Array2d next_m;  // along the ray, to the next column and the next row
  Eigen::Array2d step_m;
  for (int axis = 0; axis < 2; ++axis) {
    const double border_m = kCell_m * (cell[axis] + (direction[axis] > 0.0 ? 1 : 0));
    const bool is_parallel = std::abs(direction[axis]) < 1e-12;
    step_m[axis] =
        is_parallel ? std::numeric_limits<double>::infinity() : kCell_m / std::abs(direction[axis]);
    next_m[axis] = is_parallel ? std::numeric_limits<double>::infinity()
                               : (border_m - from_m[axis]) / direction[axis];
  }
  double range = 0.0;
  while (range < most_m) {
    if (is_wall(cell[0], cell[1])) return range;
    const int axis = next_m[0] < next_m[1] ? 0 : 1;
    range = next_m[axis];
    next_m[axis] += step_m[axis];
    cell[axis] += direction[axis] > 0.0 ? 1 : -1;
  }
  return most_m;
}

}  // namespace waymark::drawn
