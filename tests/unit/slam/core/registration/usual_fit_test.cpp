// SPDX-License-Identifier: BSD-3-Clause
// Scans that fit worse than others.
#include "slam/core/registration/usual_fit.hpp"

#include "fits.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(UsualFit, AViewOfANewPlaceIsWorseThanUsualButNotContradicted) {
  const UsualFit usual = after_good_scans();
  const ScanMatch new_place = fit(0.95, 0.5);
  EXPECT_TRUE(usual.is_worse_than_usual(new_place));
  EXPECT_TRUE(usual.is_as_usual_where_mapped(new_place));
  EXPECT_FALSE(usual.is_contradicted(new_place));
  EXPECT_FALSE(usual.is_refuted(new_place));
}

TEST(UsualFit, WallsInOtherPlacesContradict) {
  const UsualFit usual = after_good_scans();
  EXPECT_TRUE(usual.is_contradicted(fit(0.7, 1.0)));
  EXPECT_FALSE(usual.is_refuted(fit(0.7, 1.0)));
  EXPECT_FALSE(usual.is_as_usual_where_mapped(fit(0.85, 1.0)));
  EXPECT_TRUE(usual.is_refuted(fit(0.4, 1.0)));
}

TEST(UsualFit, TooFewMappedBeamsRefuteNothing) {
  EXPECT_FALSE(after_good_scans().is_refuted(fit(0.0, 0.1)));
}

TEST(UsualFit, AnUnmappedScanIsNoContradictionAndLeavesTheMeanUnchanged) {
  UsualFit usual = after_good_scans();
  EXPECT_FALSE(usual.is_contradicted(fit(0.0, 0.0)));
  for (int i = 0; i < 100; ++i)
    usual.note_scan(fit(0.0, 0.0));
  EXPECT_TRUE(usual.is_contradicted(fit(0.7, 1.0)));
}

TEST(UsualFit, BeforeTheFirstScanNoFitIsWorseThanUsual) {
  const UsualFit usual{kMinInliers, 0.5};
  EXPECT_FALSE(usual.is_worse_than_usual(fit(0.6, 0.3)));
  EXPECT_FALSE(usual.is_contradicted(fit(0.6, 0.3)));
}

}  // namespace
}  // namespace waymark
