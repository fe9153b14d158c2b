// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/drawing/view.hpp"

namespace waymark::viewer {

cv::Matx23d View::page_from_cells(const GridMap& map) const {
  // For cv::warpAffine, pixel centres have integer coordinates in the map's picture and on the
  // page; (*this)() counts from the corner of the upper left pixel.
  const cv::Point2d half{0.5, 0.5};
  const cv::Point2d zero = (*this)(map.cell_centre_m(0, 0)) - half;
  const cv::Point2d along_columns = (*this)(map.cell_centre_m(0, 1)) - half - zero;
  const cv::Point2d along_rows = (*this)(map.cell_centre_m(1, 0)) - half - zero;
  return {along_columns.x, along_rows.x, zero.x, along_columns.y, along_rows.y, zero.y};
}

}  // namespace waymark::viewer
