// SPDX-License-Identifier: BSD-3-Clause
// Draws markers as PNGs that print at true size.
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

/// Parses ids and ranges: "0-3,7" -> 0 1 2 3 7.
/// @throws std::runtime_error naming the part that is neither an id nor a range.
std::vector<int> parse_ids(const std::string& text);

/// The marker with its black border, one pixel per module: 0 = black, 255 = white.
/// @throws std::runtime_error if the options or the id are invalid.
cv::Mat marker_modules(const SheetOptions& options, int id);

/// The marker with its quiet zone, below it a caption with id and size. Modules have whole pixels,
/// so the black square may differ from size_m by half a pixel per module at the wanted resolution;
/// `pixels_per_m` is the resolution at which it has size_m exactly.
struct Sheet {
  cv::Mat picture{};
  double pixels_per_m{};
};

/// @throws std::runtime_error if the options or the id are invalid.
void check_sheet(const SheetOptions& options, int id);

/// @throws std::runtime_error if the options or the id are invalid.
Sheet draw_sheet(const SheetOptions& options, int id);

/// Writes a PNG with its resolution, so that it prints at true size; creates the folder.
/// @throws std::runtime_error if it cannot be written.
void write_png(const Sheet& sheet, const std::filesystem::path& file);

/// Writes marker_<dictionary>_<id>.png for each id; none if one of them cannot be drawn.
/// @return the files written.
/// @throws std::runtime_error if a sheet cannot be drawn or written.
std::vector<std::filesystem::path> write_sheets(const SheetOptions& options,
                                                const std::vector<int>& ids,
                                                const std::filesystem::path& folder);

}  // namespace waymark::marker_sheet
