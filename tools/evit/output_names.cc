#include "tools/evit/output_names.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace evit::commands {
namespace {

namespace fs = std::filesystem;

// Of LCM's event logs.
constexpr std::array<char, 4> kLogSync = {'\xED', '\xA1', '\xDA', '\x01'};

// Whether a folder takes a new file, by making one: rights, read-only disks and quotas are not told
// otherwise. Empty, or why not.
std::string WhyNotWritable(const fs::path& folder) {
  std::string name = (folder / ".evit.XXXXXX").string();
  const int file = mkstemp(name.data());
  if (file < 0) return std::strerror(errno);
  close(file);
  unlink(name.c_str());
  return "";
}

void RequireWritable(const std::string& what, const fs::path& folder) {
  const std::string why = WhyNotWritable(folder);
  if (!why.empty())
    throw std::runtime_error(what + ": nothing can be written to " + folder.string() + " (" + why +
                             "); give another folder, or change its permissions");
}

// Where a symbolic link leads, as the file written will be put there.
fs::path Target(const std::string& path) {
  std::error_code error;
  fs::path target = path;
  for (int links = 0; links < 40 && fs::is_symlink(target, error); ++links) {
    const fs::path to = fs::read_symlink(target, error);
    if (error) break;
    target = to.is_absolute() ? to : target.parent_path() / to;
  }
  return target;
}

bool IsLogOrEmpty(const std::string& path) {
  std::array<char, kLogSync.size()> begin{};
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), begin.size());
  return file.gcount() == 0 || begin == kLogSync;
}

}  // namespace

void RequireOutput(const std::string& option, const std::string& path) {
  if (path.empty()) return;
  std::error_code error;
  const fs::path folder = Target(path).parent_path();
  if (!folder.empty() && fs::exists(folder, error) && !fs::is_directory(folder, error))
    throw std::runtime_error(option + " " + path + ": " + folder.string() + " is a file, not a folder");
  if (!folder.empty() && !fs::is_directory(folder, error))
    throw std::runtime_error(option + " " + path + ": there is no folder " + folder.string() + "; mkdir -p " +
                             folder.string());
  if (fs::is_directory(path, error))
    throw std::runtime_error(option + " " + path + ": is a folder; give the file a name");
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    throw std::runtime_error(option + " " + path + ": is a device or a pipe; give the name of a file");
  RequireWritable(option + " " + path, folder.empty() ? fs::path(".") : folder);
}

void RequireOutputFolder(const std::string& option, const std::string& path) {
  if (path.empty()) return;
  std::error_code error;
  fs::path there = fs::absolute(path).lexically_normal();
  while (!fs::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there, error))
    throw std::runtime_error(option + " " + path + ": " +
                             (fs::equivalent(there, path, error) ? "is" : there.string() + " is") +
                             " a file, a folder is needed; give another name");
  RequireWritable(option + " " + path, there);
}

void RequireLogOutput(const std::string& option, const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error))
    throw std::runtime_error(option + " " + path + ": is a folder; give the log a name, such as " +
                             (fs::path(path) / "recording.lcmlog").lexically_normal().string());
  RequireOutput(option, path);
  if (fs::exists(path, error) && !IsLogOrEmpty(path))
    throw std::runtime_error(
        option + " " + path +
        ": exists and is not a log, and would be lost; give another name, or remove it first");
}

void RequireNotAnInput(const std::string& option, const std::string& path,
                       const std::vector<std::string>& inputs) {
  const auto same = [&](const std::string& input) {
    std::error_code error;
    if (input.empty() || path.empty()) return false;
    if (fs::equivalent(path, input, error) && !error) return true;
    // Of two outputs neither may be there yet.
    return fs::weakly_canonical(path, error) == fs::weakly_canonical(input, error) && !error;
  };
  const auto input = std::find_if(inputs.begin(), inputs.end(), same);
  if (input == inputs.end()) return;
  throw std::runtime_error(option + " " + path + ": is " + (*input == path ? "an input" : *input) +
                           ", which would be lost; give another name");
}

}  // namespace evit::commands
