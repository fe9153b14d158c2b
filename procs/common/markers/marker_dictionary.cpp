// SPDX-License-Identifier: BSD-3-Clause
#include "common/markers/marker_dictionary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

namespace waymark {
namespace {

constexpr int kAsInOpenCv = -1;

struct NamedDictionary {
  std::string_view name;
  cv::aruco::PREDEFINED_DICTIONARY_NAME value;
  int correctable_bits{kAsInOpenCv};
};

// With code distance d (36h11: d = 11) an AprilTag family can correct floor((d - 1) / 2) bits.
// 16h5 gets 0: its 16 bits match random image content too often.
constexpr std::array kDictionaries{
    NamedDictionary{"DICT_4X4_50", cv::aruco::DICT_4X4_50},
    NamedDictionary{"DICT_4X4_100", cv::aruco::DICT_4X4_100},
    NamedDictionary{"DICT_4X4_250", cv::aruco::DICT_4X4_250},
    NamedDictionary{"DICT_4X4_1000", cv::aruco::DICT_4X4_1000},
    NamedDictionary{"DICT_5X5_50", cv::aruco::DICT_5X5_50},
    NamedDictionary{"DICT_5X5_100", cv::aruco::DICT_5X5_100},
    NamedDictionary{"DICT_5X5_250", cv::aruco::DICT_5X5_250},
    NamedDictionary{"DICT_5X5_1000", cv::aruco::DICT_5X5_1000},
    NamedDictionary{"DICT_6X6_50", cv::aruco::DICT_6X6_50},
    NamedDictionary{"DICT_6X6_100", cv::aruco::DICT_6X6_100},
    NamedDictionary{"DICT_6X6_250", cv::aruco::DICT_6X6_250},
    NamedDictionary{"DICT_6X6_1000", cv::aruco::DICT_6X6_1000},
    NamedDictionary{"DICT_7X7_50", cv::aruco::DICT_7X7_50},
    NamedDictionary{"DICT_7X7_100", cv::aruco::DICT_7X7_100},
    NamedDictionary{"DICT_7X7_250", cv::aruco::DICT_7X7_250},
    NamedDictionary{"DICT_7X7_1000", cv::aruco::DICT_7X7_1000},
    NamedDictionary{"DICT_ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL},
    NamedDictionary{"DICT_APRILTAG_16h5", cv::aruco::DICT_APRILTAG_16h5, 0},
    NamedDictionary{"DICT_APRILTAG_25h9", cv::aruco::DICT_APRILTAG_25h9, 4},
    NamedDictionary{"DICT_APRILTAG_36h10", cv::aruco::DICT_APRILTAG_36h10, 4},
    NamedDictionary{"DICT_APRILTAG_36h11", cv::aruco::DICT_APRILTAG_36h11, 5},
};

}  // namespace

std::optional<cv::aruco::Dictionary> find_dictionary(std::string_view name) {
  for (const NamedDictionary& known : kDictionaries) {
    if (known.name != name) continue;
    cv::aruco::Dictionary dictionary = *cv::aruco::getPredefinedDictionary(known.value);
    if (known.correctable_bits != kAsInOpenCv) {
      dictionary.maxCorrectionBits = known.correctable_bits;
    }
    return dictionary;
  }
  return std::nullopt;
}

std::vector<std::string> dictionary_names() {
  std::vector<std::string> names;
  for (const NamedDictionary& known : kDictionaries)
    names.emplace_back(known.name);
  return names;
}

int size_of(const cv::aruco::Dictionary& dictionary) {
  return dictionary.bytesList.rows;
}

int modules_per_side(const cv::aruco::Dictionary& dictionary) {
  return dictionary.markerSize + 2;
}

void check_dictionary(const MarkerConfig& markers, Problems& problems) {
  const auto dictionary = find_dictionary(markers.dictionary);
  if (!dictionary) {
    problems.add("robot.markers.dictionary",
                 fmt::format("got '{}', expected one of {}", markers.dictionary,
                             fmt::join(dictionary_names(), ", ")));
    return;
  }
  for (const int id : markers.ids) {
    if (id < size_of(*dictionary)) continue;
    problems.add("robot.markers.ids", fmt::format("got {}, but {} has the ids 0 to {}", id,
                                                  markers.dictionary, size_of(*dictionary) - 1));
  }
}

}  // namespace waymark
