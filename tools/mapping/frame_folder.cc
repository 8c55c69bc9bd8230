#include "tools/mapping/frame_folder.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace evit::mapping {
namespace {

namespace fs = std::filesystem;

struct Picture {
  fs::path path;
  std::optional<Utime> t;
};

bool IsPicture(const fs::path& path) {
  std::string end = path.extension().string();
  std::transform(end.begin(), end.end(), end.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* known : {".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".pgm"}) {
    if (end == known) return true;
  }
  return false;
}

// Seconds where there is a decimal point, else s, us or ns by the size of the number.
std::optional<Utime> ParseStamp(const std::string& text) {
  if (text.empty() || text.find_first_not_of("0123456789.") != std::string::npos) return std::nullopt;
  const std::size_t point = text.find('.');
  if (point != std::string::npos) {
    // As text, so that no microsecond is lost.
    std::string micros = text.substr(point + 1, 6);
    if (point == 0 || point > 11 || micros.find('.') != std::string::npos) return std::nullopt;
    micros.resize(6, '0');
    return std::stoll(text.substr(0, point)) * 1'000'000 + std::stoll(micros);
  }
  if (text.size() > 19) return std::nullopt;
  const std::int64_t number = std::stoll(text);
  if (number > 10'000'000'000'000'000) return number / 1000;  // ns since 1970
  if (number > 10'000'000'000'000) return number;             // us
  return number * 1'000'000;
}

// 000, 001, ... are numbers, not stamps.
std::optional<Utime> StampInName(const std::string& name) {
  const bool counts = name.find('.') == std::string::npos && name.size() < 10;
  return counts ? std::nullopt : ParseStamp(name);
}

std::vector<Picture> ReadList(const fs::path& list, const fs::path& folder) {
  std::ifstream file(list);
  std::vector<Picture> pictures;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    std::istringstream words(line);
    std::string stamp, name;
    words >> stamp >> name;
    const std::optional<Utime> t = ParseStamp(stamp);
    if (!t || name.empty()) {
      throw std::runtime_error(list.string() + ": line " + std::to_string(number) +
                               ": expected a stamp and the name of a picture");
    }
    // Names are given from the list's folder (TUM, RPG), or from the pictures'.
    fs::path path = list.parent_path() / name;
    if (!fs::exists(path)) path = folder / fs::path(name).filename();
    pictures.push_back({path, t});
  }
  return pictures;
}

std::vector<Picture> Pictures(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw std::runtime_error(folder.string() + ": no such folder; expected one with pictures");
  const fs::path above = fs::absolute(folder).lexically_normal().parent_path();
  for (const fs::path& place : {fs::path(folder), above}) {
    for (const char* name : {"images.txt", "rgb.txt", "image_timestamps.txt", "timestamps.txt"}) {
      if (!fs::is_regular_file(place / name)) continue;
      std::vector<Picture> listed = ReadList(place / name, folder);
      if (!listed.empty()) return listed;
    }
  }
  std::vector<Picture> pictures;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && IsPicture(entry.path()))
      pictures.push_back({entry.path(), StampInName(entry.path().stem().string())});
  }
  if (pictures.empty())
    throw std::runtime_error(folder.string() + ": contains no picture (PNG, JPEG, BMP, TIFF or PGM)");
  std::sort(pictures.begin(), pictures.end(),
            [](const Picture& a, const Picture& b) { return a.path < b.path; });
  return pictures;
}

std::string Seconds(Utime t) {
  std::ostringstream text;
  text.precision(3);
  text << std::fixed << static_cast<double>(t) * 1e-6;
  return text.str();
}

}  // namespace

FrameList ListFrames(const std::string& folder, const Trajectory& poses, const std::string& poses_path) {
  if (poses.empty()) throw std::runtime_error(poses_path + ": holds no pose");
  std::vector<Picture> pictures = Pictures(folder);
  FrameList list;
  std::size_t within = 0, stamped = 0;
  for (const Picture& p : pictures) {
    if (!p.t) continue;
    ++stamped;
    if (*p.t >= poses.front().t && *p.t <= poses.back().t) ++within;
  }
  list.by_stamp = stamped == pictures.size() && within > 0;
  if (!list.by_stamp) {
    if (pictures.size() == poses.size()) {
      for (std::size_t k = 0; k < poses.size(); ++k)
        list.frames.push_back({pictures[k].path.string(), poses[k].t, poses[k].pose});
      return list;
    }
    std::string why = folder + ": " + std::to_string(pictures.size()) + " pictures, but " + poses_path +
                      " has " + std::to_string(poses.size()) + " poses";
    if (stamped == pictures.size()) {
      why += ", of " + Seconds(poses.front().t) + " to " + Seconds(poses.back().t) +
             " s, and no picture was taken then (" + Seconds(*pictures.front().t) + " to " +
             Seconds(*pictures.back().t) + " s): another recording's poses, or another clock";
    } else {
      why += "; expected one for each in the order of names, or a list images.txt with \"stamp name\" lines";
    }
    throw std::runtime_error(why);
  }
  std::stable_sort(pictures.begin(), pictures.end(),
                   [](const Picture& a, const Picture& b) { return *a.t < *b.t; });
  for (const Picture& p : pictures) {
    Frame frame{p.path.string(), *p.t, {}};
    if (PoseAt(poses, *p.t, &frame.T_map_camera)) {
      list.frames.push_back(frame);
    } else {
      ++list.without_pose;
    }
  }
  return list;
}

std::pair<std::size_t, std::size_t> ParseRange(const std::string& range) {
  std::size_t begin = 0, end = 0;
  char colon = 0;
  std::istringstream text(range);
  if (!(text >> begin >> colon >> end) || colon != ':' || !text.eof() || begin >= end) {
    throw std::runtime_error("--frames " + range + ": expected A:B with A below B, two counts of pictures");
  }
  return {begin, end};
}

void TakeRange(const std::string& range, FrameList* list) {
  auto [begin, end] = ParseRange(range);
  end = std::min(end, list->frames.size());
  if (begin >= end)
    throw std::runtime_error("--frames " + range + ": there are only " + std::to_string(list->frames.size()) +
                             " pictures with poses");
  list->frames = {list->frames.begin() + static_cast<std::ptrdiff_t>(begin),
                  list->frames.begin() + static_cast<std::ptrdiff_t>(end)};
}

}  // namespace evit::mapping
