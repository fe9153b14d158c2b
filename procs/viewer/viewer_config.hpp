// SPDX-License-Identifier: BSD-3-Clause
// Configuration of the viewer: section [viewer], and what comes from the command line.
#pragma once

#include "common/bus/channel_names.hpp"
#include "common/config/config.hpp"
#include "viewer/core/page/style.hpp"

#include <filesystem>
#include <string>

namespace waymark {

struct ViewerSection {
  std::string title{};
  double write_period_s{5.0};
  double max_write_share{0.05};
  viewer::MapPageStyle map_page{};
  int scan_size_px{1000};

  /// Names, units and explanations of the keys: viewer_config.cpp.
  void describe(Fields& fields);
};

struct ViewerConfig {
  ViewerSection viewer{};
  std::filesystem::path out_dir{};  ///< from the command line (--out)
  std::string http{};               ///< HOST:PORT of the live page (--http); empty = none
  std::string http_token{};         ///< secret of --http-token; empty = the page is read-only
  std::string lcm_url{};            ///< where the page's commands go (--lcm-url)
  ChannelNames channels{};          ///< names of the channels at lcm_url
  bool is_replay{false};            ///< messages come from a log (--log)

  void describe(Fields& fields);
};

}  // namespace waymark
