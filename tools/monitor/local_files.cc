#include "tools/monitor/local_files.h"

#include <cstddef>
#include <filesystem>
#include <fstream>

namespace evit::monitor {
namespace {

namespace fs = std::filesystem;

pid_t ParentOf(const fs::path& process) {
  std::ifstream file(process / "stat");
  std::string text;
  std::getline(file, text);
  const std::size_t name_end = text.rfind(')');  // the name may hold anything
  if (name_end == std::string::npos || name_end + 4 >= text.size()) return 0;
  return std::atoi(text.c_str() + name_end + 4);
}

// The words of a file in which each ends with a zero: "cmdline" or "environ".
std::vector<std::string> WordsOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');) words.push_back(word);
  return words;
}

bool IsProgram(const std::vector<std::string>& words, const char* name) {
  return !words.empty() && fs::path(words[0]).filename() == name;
}

bool IsTracker(const std::vector<std::string>& words) { return IsProgram(words, "window_optimizer"); }

bool IsService(const std::vector<std::string>& words) {
  return IsTracker(words) || IsProgram(words, "map_server") || IsProgram(words, "frame_builder");
}

std::string FileOption(const fs::path& process, const std::vector<std::string>& words,
                       const std::string& option) {
  const std::string value = OptionValue(words, option);
  if (value.empty()) return "";
  std::error_code error;
  const fs::path path = fs::read_symlink(process / "cwd", error) / value;
  return !error && fs::is_regular_file(path, error) ? path.string() : "";
}

void Take(const fs::path& process, const std::vector<std::string>& words, LocalFiles* files) {
  if (files->map.empty()) files->map = FileOption(process, words, "--map");
  if (files->rig.empty()) files->rig = FileOption(process, words, "--rig");
  if (IsTracker(words)) files->start = OptionValue(words, "--initial-pose");
}

// The bus it was told; empty: none.
std::string BusOf(const fs::path& process, const std::vector<std::string>& words) {
  const std::string url = OptionValue(words, "--lcm-url");
  return url.empty() ? OptionValue(WordsOf(process / "environ"), "LCM_DEFAULT_URL") : url;
}

bool SharesNetwork(const fs::path& process) {
  std::error_code error;
  return fs::read_symlink(process / "ns/net", error) == fs::read_symlink("/proc/self/ns/net", error) &&
         !error;
}

template <typename Look>
void ForEachProcess(const Look& look) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/proc", error)) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") == std::string::npos) look(entry.path());
  }
}

}  // namespace

std::string OptionValue(const std::vector<std::string>& command_line, const std::string& option) {
  for (std::size_t i = 0; i < command_line.size(); ++i) {
    if (command_line[i] == option && i + 1 < command_line.size()) return command_line[i + 1];
    if (command_line[i].rfind(option + "=", 0) == 0) return command_line[i].substr(option.size() + 1);
  }
  return "";
}

LocalFiles FindLocalFiles(pid_t supervisor) {
  LocalFiles files;
  ForEachProcess([&](const fs::path& process) {
    if (ParentOf(process) == supervisor) Take(process, WordsOf(process / "cmdline"), &files);
  });
  return files;
}

LocalFiles FindLocalFiles(const std::string& url, const std::string& prefix) {
  LocalFiles files;
  ForEachProcess([&](const fs::path& process) {
    const std::vector<std::string> words = WordsOf(process / "cmdline");
    if (!IsService(words) || OptionValue(words, "--prefix") != prefix) return;
    if (BusOf(process, words) != url || !SharesNetwork(process)) return;
    Take(process, words, &files);
  });
  return files;
}

}  // namespace evit::monitor
