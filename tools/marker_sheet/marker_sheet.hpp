// SPDX-License-Identifier: BSD-3-Clause
// A picture of a marker to print and put on a wall.
#pragma once

#include <opencv2/core.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace waymark::marker_sheet {

struct SheetOptions {
  std::string dictionary{"DICT_6X6_250"};
  double size_m{0.4};  ///< side of the black square
  int quiet_zone_modules{2};
  double dpi{300.0};
};

/// "0-3,7" -> 0 1 2 3 7. @throws std::runtime_error naming the part that is not an id or a range.
std::vector<int> parse_ids(const std::string& text);

/// One pixel per module, the black border included: 0 is black.
/// @throws std::runtime_error if the options or the id make no marker.
cv::Mat marker_modules(const SheetOptions& options, int id);

/// The marker, its quiet zone, and below that the id and the size in words. Modules are squares of
/// whole pixels, so the black square may differ from size_m by half a pixel per module; the dots
/// per metre that make up for it are in `pixels_per_m`.
struct Sheet {
  cv::Mat picture{};
  double pixels_per_m{};
};

/// @throws std::runtime_error if the options or the id make no marker.
void check_sheet(const SheetOptions& options, int id);

/// @throws std::runtime_error if the options or the id make no marker.
Sheet draw_sheet(const SheetOptions& options, int id);

/// With its resolution, so that it prints at its true size; makes the folder.
/// @throws std::runtime_error if it cannot be written.
void write_png(const Sheet& sheet, const std::filesystem::path& file);

/// Writes marker_<dictionary>_<id>.png for each id with its resolution, so that it prints at its
/// true size; nothing where one of them cannot be drawn.
/// @throws std::runtime_error if a sheet cannot be drawn or written.
std::vector<std::filesystem::path> write_sheets(const SheetOptions& options,
                                                const std::vector<int>& ids,
                                                const std::filesystem::path& folder);

}  // namespace waymark::marker_sheet
