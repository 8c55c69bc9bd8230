#pragma once

#include <string>
#include <vector>

#include "tools/monitor/web_server.h"

namespace evit::monitor {

/// share/evit-monitor beside the running program's bin/: where the page is, if it was built.
std::string PageFolder();

/// The page's files. Where it was not built (`folder` has no page), a page that says so and what to do.
std::vector<WebFile> LoadPage(const std::string& folder);

/// For the terminal: that the page was not built, and what to do. Empty where it is there.
std::string MissingPage(const std::string& folder);

}  // namespace evit::monitor
