#include "tools/formats/frames/file_frames.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "common/files/table_reader.h"
#include "common/text/natural_order.h"
#include "common/text/words.h"

namespace evit::formats {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLeastDigits = 10;  // of a stamp in a name: 000, 001, ... only count

bool IsPicture(const std::string& name) {
  const std::string lower = LowerCase(name);
  for (const char* end : {".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".pgm"}) {
    if (EndsWith(lower, end)) return true;
  }
  return false;
}

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

}  // namespace

FileFrames::FileFrames(std::unique_ptr<FileTree> tree, const std::string& path, bool depth)
    : tree_(std::move(tree)) {
  const std::vector<std::string> pictures = PicturesOf(*tree_, path, depth);
  const std::string folder = FolderOf(pictures.front());
  const std::string inside = folder.empty() ? "" : folder + "/", above = FolderOf(folder);
  const std::string name_of_folder =
      fs::path(folder.empty() ? fs::weakly_canonical(path).generic_string() : folder).filename().string();
  const char* lists[] = {depth ? "depth.txt" : "rgb.txt",
                         "images.txt",
                         "image_timestamps.txt",
                         "timestamps.txt",
                         "times.txt",
                         "data.csv"};
  for (const std::string& place :
       {inside, folder.empty() ? std::string("../") : above + (above.empty() ? "" : "/")}) {
    for (const char* list : lists) {
      if (tree_->Has(place + list) && TakeList(place + list, pictures, name_of_folder)) return;
    }
  }
  for (const std::string& picture : pictures) Add(picture, StampInName(picture));
}

void FileFrames::Add(const std::string& file, const std::string& stamp) {
  files_.push_back(file);
  frames_.push_back({tree_->PathOf(file), stamp});
}

// False where the list is about other pictures.
bool FileFrames::TakeList(const std::string& list, const std::vector<std::string>& pictures,
                          const std::string& name_of_folder) {
  const std::vector<std::uint8_t> bytes = tree_->Read(list);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  TableReader table(text, tree_->PathOf(list), "stamp name");
  const std::set<std::string> known(pictures.begin(), pictures.end());
  const std::string folder = FolderOf(pictures.front()), beside = FolderOf(list);
  std::vector<std::pair<std::string, std::string>> rows;  // file, stamp
  std::size_t nameless = 0, elsewhere = 0;
  while (table.Next()) {
    const std::string stamp(table.Word());
    double number = 0;
    if (!ParseNumber(stamp, &number)) table.Fail("\"" + stamp + "\" is not a stamp");
    if (!table.more()) {
      ++nameless;
      rows.emplace_back("", stamp);
      continue;
    }
    // Names are given from the list's folder (TUM, RPG), or from the pictures'. Colour and depth often have
    // files of the same names.
    const fs::path name{std::string(table.Word())};
    const std::string in_folder = name.parent_path().filename().string();
    const std::string file = (fs::path(folder) / name.filename()).lexically_normal().generic_string();
    const bool other = beside != folder && !in_folder.empty() && in_folder != name_of_folder;
    if (other || known.count(file) == 0) {
      ++elsewhere;
      continue;
    }
    rows.emplace_back(file, stamp);
  }
  if (rows.empty()) return false;
  const std::string path = tree_->PathOf(list);
  if (nameless > 0) {
    // Of another sensor, if it lies above.
    if (nameless == pictures.size() && elsewhere == 0) {
      for (std::size_t k = 0; k < pictures.size(); ++k) Add(pictures[k], rows[k].second);
      return true;
    }
    if (beside != folder) return false;
    throw std::runtime_error(path + ": " + std::to_string(nameless) +
                             " rows hold a stamp alone, but there are " + std::to_string(pictures.size()) +
                             " pictures; expected \"stamp name\", or one stamp for each picture");
  }
  if (rows.size() < elsewhere) return false;
  for (const auto& [file, stamp] : rows) Add(file, stamp);
  return true;
}

StoredPicture FileFrames::Fetch(std::size_t k) {
  StoredPicture picture;
  picture.bytes = tree_->Read(files_.at(k));
  return picture;
}

}  // namespace evit::formats
