#include "tools/monitor/page_files.h"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace evit::monitor {
namespace {

namespace fs = std::filesystem;

constexpr char kNoPage[] = R"(<!doctype html><meta charset="utf-8"><title>evit monitor</title>
<h1>This build of EVIT has no page</h1>
<p>It is built where Node.js is: <code>apt install nodejs npm</code>, then <code>scripts/build</code>.
<p>Foxglove and Lichtblick can connect to this port as it is; <code>evit top</code> shows the pipeline in a terminal.
)";

std::string ReadAll(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

std::vector<WebFile> LoadPage() {
  const fs::path folder =
      fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "share" / "evit-monitor";
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
