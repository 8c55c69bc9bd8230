#include "tools/formats/ros2/bag_metadata.h"

#include <fstream>
#include <stdexcept>

namespace evit::formats {
namespace {

namespace fs = std::filesystem;

constexpr char kHead[] = "rosbag2_bagfile_information";
constexpr char kPacked[] = ".zstd";
constexpr std::size_t kMaxLines = 1'000'000;

// "    - name" to "name", without quotes; empty: the line is no entry of a list.
std::string Entry(const std::string& line) {
  const std::size_t dash = line.find_first_not_of(' ');
  if (dash == std::string::npos || line.compare(dash, 2, "- ") != 0) return "";
  const std::size_t begin = line.find_first_not_of(" '\"", dash + 1), end = line.find_last_not_of(" '\"\r");
  return begin == std::string::npos || end < begin ? "" : line.substr(begin, end - begin + 1);
}

fs::path Unpacked(fs::path file) { return file.extension() == kPacked ? file.replace_extension() : file; }

}  // namespace

bool IsBagMetadata(const std::string& begin) { return begin.find(kHead) != std::string::npos; }

void RefusePackedPart(const fs::path& file) {
  if (file.extension() != kPacked || fs::exists(Unpacked(file))) return;
  throw std::runtime_error(file.string() + ": is compressed as a file; run zstd -d on it first");
}

void RequireListedParts(const std::string& folder) {
  std::ifstream file(fs::path(folder) / kBagMetadata);
  bool in_list = false;
  std::size_t n = 0;
  for (std::string line; n < kMaxLines && std::getline(file, line); ++n) {
    if (line.find("relative_file_paths:") != std::string::npos) {
      in_list = true;
      continue;
    }
    const std::string part = in_list ? Entry(line) : "";
    if (part.empty()) {
      in_list = false;
      continue;
    }
    const fs::path path = fs::path(folder) / fs::path(part).filename();
    if (!fs::exists(path) && !fs::exists(Unpacked(path)))
      throw std::runtime_error(
          path.string() + ": is missing, which " + kBagMetadata +
          " lists as a part of the bag; copy it there, or import the other parts by their names");
  }
}

}  // namespace evit::formats
