#pragma once

#include <string>
#include <vector>

#include "tools/monitor/web_server.h"

namespace evit::monitor {

/// The page's files, from share/evit-monitor beside the running program's bin/. Where it was not built (no
/// Node.js at build time), a page that says so and what to do.
std::vector<WebFile> LoadPage();

}  // namespace evit::monitor
