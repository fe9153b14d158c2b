// SPDX-License-Identifier: BSD-3-Clause
// The black and white modules of a marker.
#pragma once

#include <Eigen/Core>
#include <opencv2/aruco.hpp>
#include <opencv2/core.hpp>

#include <cstddef>
#include <vector>

namespace waymark {

/// A marker's bits, the black border of one module about them, and white all around.
class MarkerPattern {
 public:
  /// @param bits square, 8-bit, top row first; 0 is black.
  explicit MarkerPattern(const cv::Mat& bits);

  /// Modules along a side of the black square.
  int modules() const { return modules_; }

  /// Column and row count from the black square's top left module.
  bool is_white(int column, int row) const {
    if (column < 0 || row < 0 || column >= modules_ || row >= modules_) return true;
    return is_white_[static_cast<std::size_t>(row * modules_ + column)];
  }

  /// The module at a place, in modules right of and below the black square's top left corner; one
  /// of those about the black square for all places further out.
  Eigen::Array2i module_at(const Eigen::Vector2d& modules) const {
    return modules.array().floor().max(-1.0).min(modules_).cast<int>();
  }

  bool is_white_at(const Eigen::Vector2d& modules) const {
    const Eigen::Array2i module = module_at(modules);
    return is_white(module.x(), module.y());
  }

 private:
  int modules_;
  std::vector<bool> is_white_;
};

/// The patterns of a dictionary, by id.
std::vector<MarkerPattern> marker_patterns(const cv::aruco::Dictionary& dictionary);

}  // namespace waymark
