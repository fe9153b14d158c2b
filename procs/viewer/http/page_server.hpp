// SPDX-License-Identifier: BSD-3-Clause
// The web server of the live page: serves views and the output folder, forwards commands to
// slam.
#pragma once

#include "viewer/http/http_address.hpp"
#include "viewer/http/page_commands.hpp"
#include "viewer/http/view_store.hpp"

#include <filesystem>
#include <memory>
#include <optional>

namespace waymark::viewer {

/// @throws SetupError when the address cannot be listened on.
void check_http_address(const HttpAddress& address);

/// Serves from its own threads, at a lower priority than the node.
///
/// `/` the page; `/events` server-sent events, a view each, five a second at most; `/view`,
/// `/tiles` and `/camera.jpg`, with `time_s=T` for a time in the past; the files of the output
/// folder as last written. A client that takes longer than two seconds to receive a view is
/// disconnected. With commands: POST `/command` (see parse_page_command) with the header
/// "Authorization: Bearer TOKEN": 200 done, 400 malformed, 401 wrong token, 409 refused by slam
/// with its reason, 429 another command is under way, 504 no answer. Without commands: 405.
class PageServer {
 public:
  /// @param views  must outlive this object; closed by the destructor.
  /// @throws SetupError when the address cannot be listened on.
  PageServer(const HttpAddress& address, ViewStore& views, std::filesystem::path folder,
             std::optional<PageCommands> commands = {});
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace waymark::viewer
