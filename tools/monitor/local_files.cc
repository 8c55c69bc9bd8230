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

std::vector<std::string> CommandLine(const fs::path& process) {
  std::ifstream file(process / "cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');) words.push_back(word);
  return words;
}

std::string FileOption(const fs::path& process, const std::vector<std::string>& words,
                       const std::string& option) {
  const std::string value = OptionValue(words, option);
  if (value.empty()) return "";
  std::error_code error;
  const fs::path path = fs::read_symlink(process / "cwd", error) / value;
  return !error && fs::is_regular_file(path, error) ? path.string() : "";
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
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/proc", error)) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    if (ParentOf(entry.path()) != supervisor) continue;
    const std::vector<std::string> words = CommandLine(entry.path());
    if (files.map.empty()) files.map = FileOption(entry.path(), words, "--map");
    if (files.rig.empty()) files.rig = FileOption(entry.path(), words, "--rig");
  }
  return files;
}

}  // namespace evit::monitor
