// SPDX-License-Identifier: BSD-3-Clause
#include "marker_sheet/pdf_pages.hpp"

#include <cairo-pdf.h>
#include <cairo.h>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>

namespace waymark::marker_sheet {
namespace {

constexpr double kPoint_per_mm = 72.0 / 25.4;
constexpr double kInch_mm = 25.4;
constexpr double kMinPixels_per_mm = 2.0;  // modules are some millimetres wide
constexpr double kMaxPixels = 20'000.0;    // 1.7 m at 300 dpi; guards the memory
constexpr double kHairline_mm = 0.1;
constexpr double kCutMark_mm = 5.0;
constexpr int kTextPixels_per_mm = 24;  // 600 dots per inch

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error{fmt::format("cairo: {}", cairo_status_to_string(status))};
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

void draw_line(cairo_t* to, double x1_mm, double y1_mm, double x2_mm, double y2_mm) {
  cairo_move_to(to, x1_mm, y1_mm);
  cairo_line_to(to, x2_mm, y2_mm);
  cairo_stroke(to);
}

/// Draws text as an image, so that the result does not depend on installed fonts.
void draw_text(cairo_t* to, const std::string& text, double x_mm, double y_mm, double height_mm,
               double most_width_mm) {
  constexpr double kScale = 4.0;  // OpenCV font scale; the image is then scaled to height_mm
  constexpr int kThick = 6;
  int below_px = 0;
  const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kScale, kThick, &below_px);
  const int rows = size.height + below_px + kThick;
  cv::Mat letters{rows, size.width + kThick, CV_8UC1, cv::Scalar{0}};
  cv::putText(letters, text, {kThick / 2, size.height + kThick / 2}, cv::FONT_HERSHEY_SIMPLEX,
              kScale, cv::Scalar{255}, kThick, cv::LINE_AA);
  const double mm_per_px = std::min(height_mm / rows, most_width_mm / letters.cols);
  const double resize = std::min(1.0, mm_per_px * kTextPixels_per_mm);
  cv::resize(letters, letters, {}, resize, resize, cv::INTER_AREA);
  const int stride = cairo_format_stride_for_width(CAIRO_FORMAT_A8, letters.cols);
  std::vector<unsigned char> mask(static_cast<std::size_t>(stride) *
                                  static_cast<std::size_t>(letters.rows));
  for (int row = 0; row < letters.rows; ++row)
    std::memcpy(mask.data() + static_cast<std::ptrdiff_t>(row) * stride, letters.ptr(row),
                static_cast<std::size_t>(letters.cols));
  const Surface image{cairo_image_surface_create_for_data(mask.data(), CAIRO_FORMAT_A8,
                                                          letters.cols, letters.rows, stride),
                      &cairo_surface_destroy};
  cairo_save(to);
  cairo_translate(to, x_mm, y_mm);
  cairo_scale(to, mm_per_px / resize, mm_per_px / resize);
  cairo_mask_surface(to, image.get(), 0.0, 0.0);
  cairo_restore(to);
  // cairo reads the image when the page is shown; finishing it here makes cairo copy it now.
  cairo_surface_finish(image.get());
}

/// Fills all rectangles as one path, so that no gaps show between them.
void draw_black(cairo_t* to, const Pattern& pattern, const SheetLayout& sheet) {
  for (const Rectangle& black : pattern.black)
    cairo_rectangle(to, sheet.pattern_x_mm + black.x_mm, sheet.pattern_y_mm + black.y_mm,
                    black.width_mm, black.height_mm);
  cairo_fill(to);
}

void draw_ruler(cairo_t* to, double left_mm, double y_mm, double tick_mm) {
  draw_line(to, left_mm, y_mm, left_mm + kRuler_mm, y_mm);
  constexpr double kStep_mm = 10.0;
  for (int tick = 0; tick <= static_cast<int>(kRuler_mm / kStep_mm); ++tick) {
    const double x_mm = left_mm + tick * kStep_mm;
    const bool is_end = tick == 0 || tick * kStep_mm == kRuler_mm;
    draw_line(to, x_mm, y_mm - (is_end ? 1.0 : 0.5) * tick_mm, x_mm, y_mm);
  }
}

/// Draws a ruler in the lower margin, which is cut off, to check the scale of each tile.
void draw_ruler_of_tile(cairo_t* to, const Tiling& tiling) {
  constexpr double kText_mm = 3.0;
  const double left_mm = kMargin_mm + kCutMark_mm;
  const double y_mm = 1.5 * kMargin_mm + tiling.cell_height_mm;
  draw_ruler(to, left_mm, y_mm, 0.5 * kTick_mm);
  draw_text(to, "100 mm", left_mm + kRuler_mm + kText_mm, y_mm - kText_mm, kText_mm, 20.0);
}

void draw_height_marks(cairo_t* to, const SheetLayout& sheet) {
  const double y_mm = sheet.pattern_y_mm + 0.5 * sheet.pattern_height_mm;
  const double length_mm = std::min(kTick_mm, 0.5 * sheet.quiet_mm);
  const double left_mm = sheet.pattern_x_mm - sheet.quiet_mm;
  const double right_mm = sheet.pattern_x_mm + sheet.pattern_width_mm + sheet.quiet_mm;
  draw_line(to, left_mm, y_mm, left_mm + length_mm, y_mm);
  draw_line(to, right_mm - length_mm, y_mm, right_mm, y_mm);
}

void draw_cut_marks(cairo_t* to, const Tiling& tiling) {
  const double left_mm = kMargin_mm;
  const double top_mm = kMargin_mm;
  const double right_mm = left_mm + tiling.cell_width_mm;
  const double bottom_mm = top_mm + tiling.cell_height_mm;
  for (const double x_mm : {left_mm, right_mm}) {
    draw_line(to, x_mm, top_mm - kCutMark_mm, x_mm, top_mm);
    draw_line(to, x_mm, bottom_mm, x_mm, bottom_mm + kCutMark_mm);
  }
  for (const double y_mm : {top_mm, bottom_mm}) {
    draw_line(to, left_mm - kCutMark_mm, y_mm, left_mm, y_mm);
    draw_line(to, right_mm, y_mm, right_mm + kCutMark_mm, y_mm);
  }
}

void draw_sheet_of(cairo_t* to, const Pattern& pattern, const SheetLayout& sheet) {
  draw_black(to, pattern, sheet);
  draw_height_marks(to, sheet);
  draw_text(to, pattern.caption + "   the line below has 100 mm", sheet.ruler_x_mm,
            sheet.caption_y_mm, kCaption_mm, kRuler_mm);
  draw_ruler(to, sheet.ruler_x_mm, sheet.ruler_y_mm, kTick_mm);
}

void draw_page(cairo_t* to, const Pattern& pattern, const SheetLayout& sheet, const Tiling& tiling,
               int column, int row) {
  cairo_save(to);
  cairo_scale(to, kPoint_per_mm, kPoint_per_mm);
  cairo_set_line_width(to, kHairline_mm);
  cairo_save(to);
  cairo_rectangle(to, kMargin_mm, kMargin_mm, tiling.cell_width_mm, tiling.cell_height_mm);
  cairo_clip(to);
  cairo_translate(to, kMargin_mm + tiling.offset_x_mm - column * tiling.cell_width_mm,
                  kMargin_mm + tiling.offset_y_mm - row * tiling.cell_height_mm);
  draw_sheet_of(to, pattern, sheet);
  cairo_restore(to);
  if (tiling.columns * tiling.rows > 1) {
    draw_cut_marks(to, tiling);
    draw_ruler_of_tile(to, tiling);
    constexpr double kLabel_mm = 3.0;
    draw_text(to,
              fmt::format("{}: row {} of {}, column {} of {}; cut at the marks", pattern.name,
                          row + 1, tiling.rows, column + 1, tiling.columns),
              kMargin_mm + kCutMark_mm, 0.5 * (kMargin_mm - kLabel_mm), kLabel_mm,
              tiling.cell_width_mm - 2.0 * kCutMark_mm);
  }
  cairo_restore(to);
}

}  // namespace

Pdf draw_pdf(const std::vector<Pattern>& patterns, const PageOptions& options) {
  Pdf pdf;
  const PageSize first = page_of(options.page);
  const Surface surface{
      cairo_pdf_surface_create_for_stream(&append, &pdf.bytes, kPoint_per_mm * first.width_mm,
                                          kPoint_per_mm * first.height_mm),
      &cairo_surface_destroy};
  check(cairo_surface_status(surface.get()));
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, "Markers");
  // A fixed date, so that the same input gives the same bytes.
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE,
                                 "2000-01-01T00:00:00Z");
  const Context context{cairo_create(surface.get()), &cairo_destroy};
  for (const Pattern& pattern : patterns) {
    const SheetLayout sheet = layout_of(pattern);
    const Tiling tiling = tiling_of(sheet, options.page, options.tiles);
    cairo_pdf_surface_set_size(surface.get(), kPoint_per_mm * tiling.page.width_mm,
                               kPoint_per_mm * tiling.page.height_mm);
    for (int row = 0; row < tiling.rows; ++row) {
      for (int column = 0; column < tiling.columns; ++column) {
        draw_page(context.get(), pattern, sheet, tiling, column, row);
        cairo_show_page(context.get());
        check(cairo_status(context.get()));
        ++pdf.num_pages;
      }
    }
  }
  cairo_surface_finish(surface.get());
  check(cairo_surface_status(surface.get()));
  return pdf;
}

Sheet draw_picture(const Pattern& pattern, double dpi) {
  const SheetLayout sheet = layout_of(pattern);
  const double px_per_mm = dpi / kInch_mm;
  const double largest_px = px_per_mm * std::max(sheet.width_mm, sheet.height_mm);
  if (!(px_per_mm >= kMinPixels_per_mm && largest_px <= kMaxPixels))
    throw std::runtime_error{
        fmt::format("--dpi {}: expected {:.0f} or more, and a picture of at most {:.0f} pixels",
                    dpi, kMinPixels_per_mm * kInch_mm, kMaxPixels)};
  const Surface surface{
      cairo_image_surface_create(CAIRO_FORMAT_A8,
                                 static_cast<int>(std::ceil(px_per_mm * sheet.width_mm)),
                                 static_cast<int>(std::ceil(px_per_mm * sheet.height_mm))),
      &cairo_surface_destroy};
  check(cairo_surface_status(surface.get()));
  const Context context{cairo_create(surface.get()), &cairo_destroy};
  cairo_scale(context.get(), px_per_mm, px_per_mm);
  cairo_set_line_width(context.get(), kHairline_mm);
  draw_sheet_of(context.get(), pattern, sheet);
  check(cairo_status(context.get()));
  cairo_surface_flush(surface.get());
  const cv::Mat ink{cairo_image_surface_get_height(surface.get()),
                    cairo_image_surface_get_width(surface.get()), CV_8UC1,
                    cairo_image_surface_get_data(surface.get()),
                    static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()))};
  return {255 - ink, 1e3 * px_per_mm};
}

}  // namespace waymark::marker_sheet
