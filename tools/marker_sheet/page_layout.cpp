// SPDX-License-Identifier: BSD-3-Clause
#include "marker_sheet/page_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace waymark::marker_sheet {
namespace {

constexpr double kGap_mm = 3.0;        // between border, caption and ruler
constexpr int kMaxPages = 100;         // for one pattern
constexpr double kRounding_mm = 1e-6;  // tolerance, so that a sheet as large as a page fits

struct NamedPage {
  std::string_view name;
  PageSize size;
};

constexpr std::array kPages{NamedPage{"A4", {210.0, 297.0}}, NamedPage{"A3", {297.0, 420.0}},
                            NamedPage{"Letter", {215.9, 279.4}}};

int cells(double length_mm, double cell_mm) {
  return std::max(1, static_cast<int>(std::ceil((length_mm - kRounding_mm) / cell_mm)));
}

Tiling tiling_on(const SheetLayout& sheet, PageSize page) {
  Tiling tiling{.page = page};
  tiling.cell_width_mm = page.width_mm - 2.0 * kMargin_mm;
  tiling.cell_height_mm = page.height_mm - 2.0 * kMargin_mm;
  tiling.columns = cells(sheet.width_mm, tiling.cell_width_mm);
  tiling.rows = cells(sheet.height_mm, tiling.cell_height_mm);
  if (tiling.columns == 1) tiling.offset_x_mm = 0.5 * (tiling.cell_width_mm - sheet.width_mm);
  if (tiling.rows == 1) tiling.offset_y_mm = 0.5 * (tiling.cell_height_mm - sheet.height_mm);
  return tiling;
}

}  // namespace

PageSize page_of(const std::string& name) {
  const auto page = std::ranges::find(kPages, name, &NamedPage::name);
  if (page != kPages.end()) return page->size;
  throw std::runtime_error{fmt::format("--page: got '{}', expected A4, A3 or Letter", name)};
}

SheetLayout layout_of(const Pattern& pattern) {
  SheetLayout sheet;
  sheet.pattern_width_mm = pattern.width_mm;
  sheet.pattern_height_mm = pattern.height_mm;
  sheet.quiet_mm = pattern.quiet_mm;
  sheet.width_mm = std::max(pattern.width_mm + 2.0 * pattern.quiet_mm, kRuler_mm + 2.0 * kGap_mm);
  sheet.pattern_x_mm = 0.5 * (sheet.width_mm - pattern.width_mm);
  sheet.pattern_y_mm = pattern.quiet_mm;
  sheet.caption_y_mm = pattern.height_mm + 2.0 * pattern.quiet_mm + kGap_mm;
  sheet.ruler_x_mm = 0.5 * (sheet.width_mm - kRuler_mm);
  sheet.ruler_y_mm = sheet.caption_y_mm + kCaption_mm + kGap_mm + kTick_mm;
  sheet.height_mm = sheet.ruler_y_mm + kGap_mm;
  return sheet;
}

Tiling tiling_of(const SheetLayout& sheet, const std::string& page, bool tiles) {
  const PageSize size = page_of(page);
  const Tiling upright = tiling_on(sheet, size);
  const Tiling lying = tiling_on(sheet, {size.height_mm, size.width_mm});
  const Tiling& best =
      lying.columns * lying.rows < upright.columns * upright.rows ? lying : upright;
  const int pages = best.columns * best.rows;
  if (pages > 1 && !tiles) {
    throw std::runtime_error{fmt::format(
        "{:.4g} x {:.4g} mm with border, caption and ruler need {:.0f} x {:.0f} mm, {} has "
        "{:.0f} x {:.0f} mm inside its margins: give --tile (then it is {} pages to put together), "
        "a larger --page, or a smaller pattern",
        sheet.pattern_width_mm, sheet.pattern_height_mm, sheet.width_mm, sheet.height_mm, page,
        upright.cell_width_mm, upright.cell_height_mm, pages)};
  }
  if (pages > kMaxPages) {
    throw std::runtime_error{
        fmt::format("a width of {:.4g} m: that is {} pages of {}, at most {} are written",
                    1e-3 * sheet.pattern_width_mm, pages, page, kMaxPages)};
  }
  return best;
}

}  // namespace waymark::marker_sheet
