#include "tools/monitor/page_files.h"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace evit::monitor {
namespace {

namespace fs = std::filesystem;

// The default build of the programs leaves it out; scripts/setup does nothing where Node.js is there.
#define EVIT_BUILD_PAGE "scripts/setup programs page && scripts/build release monitor_page"

constexpr char kNoPage[] = R"(<!doctype html><meta charset="utf-8"><title>evit monitor</title>
<h1>This page has not been built</h1>
<p>In the folder of EVIT's sources run <code>)" EVIT_BUILD_PAGE R"(</code>, then start the monitor again.
<p>Foxglove and Lichtblick can connect to this port as it is; <code>evit top</code> shows the pipeline in a terminal.
)";

std::string ReadAll(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

std::string PageFolder() {
  return fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "share" / "evit-monitor";
}

std::string MissingPage(const std::string& folder) {
  if (fs::exists(fs::path(folder) / "index.html")) return "";
  return "its page has not been built; in the folder of EVIT's sources run: " EVIT_BUILD_PAGE;
}

std::vector<WebFile> LoadPage(const std::string& page) {
  const fs::path folder = page;
  std::vector<WebFile> files;
  const auto add = [&](const char* name, const char* type) {
    if (fs::exists(folder / name)) files.push_back({name, type, ReadAll(folder / name)});
  };
  add("index.html", "text/html; charset=utf-8");
  if (files.empty()) return {{"", "text/html; charset=utf-8", kNoPage}};
  files.front().name = "";
  add("monitor.js", "text/javascript; charset=utf-8");
  add("monitor.css", "text/css; charset=utf-8");
  add("icon.svg", "image/svg+xml");
  return files;
}

}  // namespace evit::monitor
