// SPDX-License-Identifier: BSD-3-Clause
// Real photographs, kept outside the project: the detector must read at least the markers that
// cv::aruco reads, and no false ids. Skipped where the photographs are absent.
#include "common/markers/marker_dictionary.hpp"
#include "detector/core/marker_detector.hpp"

#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>
#include <opencv2/imgcodecs.hpp>

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace waymark {
namespace {

struct Photograph {
  std::string file;
  std::string dictionary;
  std::set<int> ids;
};

std::set<int> up_to(int last) {
  std::set<int> ids;
  for (int id = 0; id <= last; ++id)
    ids.insert(id);
  return ids;
}

std::vector<Photograph> photographs() {
  std::set<int> occluded = up_to(10);
  occluded.insert({12, 15});
  return {{"singlemarkersoriginal.jpg", "DICT_6X6_250", {23, 40, 62, 98, 124, 203}},
          {"choriginal.jpg", "DICT_6X6_250", up_to(16)},
          {"chocclusion_original.jpg", "DICT_6X6_250", occluded},
          {"tag_01_d7_14cm.png", "DICT_5X5_1000", {1}},
          {"tag_245-246_d7_14cm.png", "DICT_5X5_1000", {245, 246}},
          {"403.jpg", "DICT_5X5_1000", {403}},
          {"ubiquity_bag_frame.jpg", "DICT_5X5_1000", {100, 103, 106, 107, 110, 111, 112}}};
}

std::optional<std::filesystem::path> photograph_folder() {
  const std::filesystem::path source{WAYMARK_SOURCE_DIR};
  // Beside the project, or beside the folder of its worktrees.
  for (const auto& shared : {source / "../shared", source / "../../shared"}) {
    if (std::filesystem::is_directory(shared / "data/photos")) return shared / "data/photos";
  }
  return std::nullopt;
}

std::set<int> ids_by_opencv(const cv::Mat& gray, const std::string& dictionary_name) {
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  cv::aruco::detectMarkers(
      gray, cv::makePtr<cv::aruco::Dictionary>(*find_dictionary(dictionary_name)), corners, ids);
  return {ids.begin(), ids.end()};
}

/// The cameras of the photographs are unknown; any plausible one is good enough to read ids.
RobotConfig robot_for(const cv::Mat& gray, const std::string& dictionary) {
  RobotConfig robot;
  robot.camera.width_px = gray.cols;
  robot.camera.height_px = gray.rows;
  robot.camera.fx_px = robot.camera.fy_px = 0.9 * gray.cols;
  robot.camera.cx_px = 0.5 * (gray.cols - 1);
  robot.camera.cy_px = 0.5 * (gray.rows - 1);
  robot.markers.dictionary = dictionary;
  return robot;
}

TEST(Photographs, DetectsAtLeastAsManyMarkersAsOpenCvAndNoFalseId) {
  const auto folder = photograph_folder();
  if (!folder) GTEST_SKIP() << "no photographs in shared/data/photos beside the source folder";
  for (const Photograph& photograph : photographs()) {
    const cv::Mat gray = cv::imread((*folder / photograph.file).string(), cv::IMREAD_GRAYSCALE);
    ASSERT_FALSE(gray.empty()) << photograph.file;
    std::set<int> seen;
    for (const MarkerDetection& marker :
         MarkerDetector{robot_for(gray, photograph.dictionary), {}}.detect(gray)) {
      EXPECT_TRUE(photograph.ids.contains(marker.id)) << photograph.file << ": " << marker.id;
      EXPECT_TRUE(seen.insert(marker.id).second) << photograph.file << ": twice " << marker.id;
    }
    for (const int id : ids_by_opencv(gray, photograph.dictionary)) {
      if (photograph.ids.contains(id)) {
        EXPECT_TRUE(seen.contains(id)) << photograph.file << ": " << id;
      }
    }
    RecordProperty(photograph.file,
                   std::to_string(seen.size()) + " of " + std::to_string(photograph.ids.size()));
  }
}

}  // namespace
}  // namespace waymark
