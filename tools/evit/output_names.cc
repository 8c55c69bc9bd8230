#include "tools/evit/output_names.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace evit::commands {
namespace {

namespace fs = std::filesystem;

// Of LCM's event logs.
constexpr std::array<char, 4> kLogSync = {'\xED', '\xA1', '\xDA', '\x01'};

bool IsLogOrEmpty(const std::string& path) {
  std::array<char, kLogSync.size()> begin{};
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), begin.size());
  return file.gcount() == 0 || begin == kLogSync;
}

}  // namespace

void RequireOutput(const std::string& option, const std::string& path) {
  std::error_code error;
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, error))
    throw std::runtime_error(option + " " + path + ": there is no folder " + folder.string() + "; mkdir -p " +
                             folder.string());
  if (fs::is_directory(path, error))
    throw std::runtime_error(option + " " + path + ": is a folder; give the file a name");
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    throw std::runtime_error(option + " " + path + ": is a device or a pipe; give the name of a file");
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
    return !input.empty() && fs::equivalent(path, input, error) && !error;
  };
  const auto input = std::find_if(inputs.begin(), inputs.end(), same);
  if (input == inputs.end()) return;
  throw std::runtime_error(option + " " + path + ": is " + (*input == path ? "an input" : *input) +
                           ", which would be lost; give another name");
}

}  // namespace evit::commands
