#include "tools/formats/frames/file_frames.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "common/files/decimal_time.h"
#include "common/text/natural_order.h"
#include "common/text/words.h"

namespace evit::formats {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLeastDigits = 10;  // of a stamp in a name: 000, 001, ... only count
constexpr Utime kEpochSeconds =
    1'000'000'000;               // no count of pictures gets there; seconds since 1970 did in 2001
constexpr Utime kLeastStep = 5;  // from name to name, of whatever unit; less counts pictures

std::string FolderOf(const std::string& name) { return fs::path(name).parent_path().generic_string(); }

// "frame_1600000000.100000" -> "1600000000.100000": the last number, if it is one that tells a time.
std::string StampInName(const std::string& file) {
  const std::string stem = fs::path(file).stem().string();
  const std::size_t end = stem.find_last_of("0123456789");
  if (end == std::string::npos) return "";
  const std::size_t before = stem.find_last_not_of("0123456789.", end);
  std::string number = stem.substr(before + 1, end - before);  // npos + 1 is 0
  number.erase(0, number.find_first_not_of('.'));
  const bool counts = number.find('.') == std::string::npos && number.size() < kLeastDigits;
  Utime t = 0;
  return counts || !ParseDecimalTime(number, TimeUnit::kNanoseconds, &t) ? "" : number;
}

// Of all pictures; none where one has none, or where they count: 0000000000, 0000000001, ... (KITTI).
std::vector<std::string> StampsInNames(const std::vector<std::string>& files) {
  std::vector<std::string> stamps;
  bool counts = true;
  Utime last = 0;
  for (const std::string& file : files) {
    stamps.push_back(StampInName(file));
    if (stamps.back().empty()) return std::vector<std::string>(files.size());
    Utime t = 0;
    counts = counts && stamps.back().find('.') == std::string::npos &&
             ParseDecimalTime(stamps.back(), TimeUnit::kMicroseconds, &t) && t < kEpochSeconds &&
             (stamps.size() == 1 || t - last < kLeastStep);
    last = t;
  }
  return counts && files.size() > 1 ? std::vector<std::string>(files.size()) : stamps;
}

// The pictures of the only folder that has any; those beside the tree's root come first.
std::vector<std::string> PicturesOf(const FileTree& tree, const std::string& path, bool depth) {
  std::map<std::string, std::vector<std::string>> folders;
  for (const std::string& name : tree.names()) {
    if (IsPicture(name)) folders[FolderOf(name)].push_back(name);
  }
  if (folders.empty()) throw std::runtime_error(path + ": contains no picture (PNG, JPEG, BMP, TIFF or PGM)");
  auto chosen = folders.find("");
  if (chosen == folders.end()) {
    chosen = folders.begin();
    if (folders.size() > 1) {
      // Colour and depth side by side have usual names.
      for (const char* usual : {depth ? "depth" : "rgb", depth ? "depth" : "images"}) {
        for (auto at = folders.begin(); at != folders.end(); ++at) {
          if (fs::path(at->first).filename() != usual) continue;
          std::sort(at->second.begin(), at->second.end(), NaturallyBefore);
          return at->second;
        }
      }
      std::string names;
      for (const auto& folder : folders) names += (names.empty() ? "" : ", ") + folder.first;
      throw std::runtime_error(path + ": has pictures in several folders: " + names + "; name the one meant" +
                               (fs::is_directory(path) ? "" : " (unpack the archive first)"));
    }
  }
  std::sort(chosen->second.begin(), chosen->second.end(), NaturallyBefore);
  return chosen->second;
}

// Names that lists of pictures usually have. A list of the other side's pictures is not meant.
std::vector<std::string> ListsFor(const std::string& folder, bool depth) {
  std::vector<std::string> lists = {depth ? "depth.txt" : "rgb.txt",
                                    "images.txt",
                                    "timestamp.txt",
                                    "image_timestamps.txt",
                                    "timestamps.txt",
                                    "times.txt",
                                    "data.csv"};
  const std::string lower = LowerCase(folder);
  const bool left = lower.find("right") == std::string::npos, right = lower.find("left") == std::string::npos;
  for (const std::string side : {left ? "left" : "", right ? "right" : ""}) {
    if (side.empty()) continue;
    lists.push_back(side + "_images.txt");                 // UZH-FPV
    lists.push_back("image_timestamps_" + side + ".txt");  // TUM-VIE
  }
  return lists;
}

}  // namespace

FileFrames::FileFrames(std::unique_ptr<FileTree> tree, const std::string& path, bool depth)
    : tree_(std::move(tree)) {
  PictureFolder pictures;
  pictures.pictures = PicturesOf(*tree_, path, depth);
  pictures.folder = FolderOf(pictures.pictures.front());
  const std::string& folder = pictures.folder;
  pictures.name =
      fs::path(folder.empty() ? fs::weakly_canonical(path).generic_string() : folder).filename().string();
  const std::vector<std::string> stamps = StampsInNames(pictures.pictures);
  pictures.stamped = !stamps.front().empty();
  const std::string above = folder.empty() ? "../" : (FolderOf(folder).empty() ? "" : FolderOf(folder) + "/");
  for (const std::string& place : {folder.empty() ? "" : folder + "/", above}) {
    for (const std::string& list : ListsFor(pictures.name, depth)) {
      if (tree_->Has(place + list) && TakeList(place + list, pictures)) return;
    }
  }
  for (std::size_t k = 0; k < stamps.size(); ++k) Add(pictures.pictures[k], stamps[k]);
}

void FileFrames::Add(const std::string& file, const std::string& stamp) {
  files_.push_back(file);
  frames_.push_back({tree_->PathOf(file), stamp});
}

// False where the list is about other pictures.
bool FileFrames::TakeList(const std::string& name, const PictureFolder& pictures) {
  const std::vector<std::uint8_t> bytes = tree_->Read(name);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto listed = ReadPictureList({text, tree_->PathOf(name), FolderOf(name)}, pictures);
  if (!listed) return false;
  for (const ListedPicture& picture : *listed) Add(picture.file, picture.stamp);
  return true;
}

StoredPicture FileFrames::Fetch(std::size_t k) {
  StoredPicture picture;
  picture.bytes = tree_->Read(files_.at(k));
  return picture;
}

}  // namespace evit::formats
