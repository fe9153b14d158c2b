// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace waymark::viewer {

/// page.html.
extern const std::string_view kPageHtml;

}  // namespace waymark::viewer
