// SPDX-License-Identifier: BSD-3-Clause
// Unit tests of the archive of scans that a map is redrawn from.
#include "slam/core/mapping/scan_archive.hpp"

#include "support/observations.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(ScanArchive, RestoresTheEndPointsOfBeams) {
  const test::SyntheticCorridor corridor = test::bare_corridor();
  const Observation scan = test::observations_of(test::drive(corridor), corridor).front();
  ScanArchive archive;
  archive.add(scan, Se2{});
  const Observation again = archive.at(0);
  ASSERT_EQ(again.beams.size(), scan.beams.size());
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    EXPECT_NEAR(again.beams[i].beam.range_m, scan.beams[i].beam.range_m, 1e-6);
    EXPECT_LT((again.beams[i].beam.end_in_base - scan.beams[i].beam.end_in_base).norm(), 1e-6);
  }
}

TEST(ScanArchive, KeepsTheNewestScansOfAPlace) {
  const test::SyntheticCorridor corridor = test::bare_corridor();
  const Observation scan = test::observations_of(test::drive(corridor), corridor).front();
  ScanArchive archive;
  archive.add(scan, Se2{5.0, 0.1, 0.1});
  for (std::size_t i = 0; i < 3 * ScanArchive::kScansPerPlace; ++i)
    archive.add(scan, Se2{1.1, 0.1, 0.1});
  EXPECT_FALSE(archive.at(0).beams.empty());
  for (std::size_t i = 1; i < archive.size(); ++i) {
    EXPECT_EQ(archive.at(i).beams.empty(), i + ScanArchive::kScansPerPlace < archive.size()) << i;
  }
}

TEST(ScanArchive, EmptyScansDoNotCountForAPlace) {
  const test::SyntheticCorridor corridor = test::bare_corridor();
  const Observation scan = test::observations_of(test::drive(corridor), corridor).front();
  ScanArchive archive;
  archive.add(scan, Se2{1.1, 0.1, 0.1});
  for (std::size_t i = 0; i < 3 * ScanArchive::kScansPerPlace; ++i) {
    EXPECT_FALSE(archive.emptied_by(Observation{}, Se2{1.1, 0.1, 0.1}));
    archive.add(Observation{}, Se2{1.1, 0.1, 0.1});
  }
  EXPECT_FALSE(archive.at(0).beams.empty());
}

}  // namespace
}  // namespace waymark
