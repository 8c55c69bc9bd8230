#include "tools/formats/recognition/recording_files.h"

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <stdexcept>

#include "common/text/words.h"
#include "tools/formats/recognition/file_kind.h"
#include "tools/formats/recognition/other_contents.h"
#include "tools/formats/ros2/bag_metadata.h"

namespace evit::formats {
namespace {

namespace fs = std::filesystem;

constexpr int kDepth = 2;  // folders in folders
constexpr std::size_t kMaxFiles = 10'000;

// Files by what they hold.
struct Sorted {
  std::vector<std::string> bags, events, beside, imu, truth;
};

std::vector<fs::path> FilesBelow(const std::string& folder) {
  std::vector<fs::path> files;
  constexpr auto kSkip = fs::directory_options::skip_permission_denied;
  for (auto at = fs::recursive_directory_iterator(folder, kSkip); at != fs::recursive_directory_iterator();
       ++at) {
    if (at.depth() >= kDepth) at.disable_recursion_pending();
    if (at->is_regular_file()) files.push_back(at->path());
    if (files.size() > kMaxFiles)
      throw std::runtime_error(folder + ": holds too many files to look through; name the recording's");
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool Contains(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

bool HasExtension(const fs::path& file, std::initializer_list<const char*> extensions) {
  const std::string extension = LowerCase(file.extension().string());
  return std::any_of(extensions.begin(), extensions.end(), [&](const char* e) { return extension == e; });
}

bool IsText(const fs::path& file) { return HasExtension(file, {".txt", ".csv", ".tsv", ".tum"}); }

bool IsPicture(const fs::path& file) { return HasExtension(file, {".png", ".jpg", ".jpeg", ".pgm"}); }

bool IsPacked(const fs::path& file) {
  return HasExtension(file, {".gz", ".bz2", ".xz", ".zst", ".lz4", ".zip", ".7z", ".rar", ".tar", ".tgz"});
}

std::string List(const std::vector<std::string>& files) {
  std::string list;
  for (const std::string& file : files) list += (list.empty() ? "" : ", ") + file;
  return list;
}

std::string OnlyOne(const std::vector<std::string>& files, const std::string& where, const char* what,
                    const char* option) {
  if (files.size() <= 1) return files.empty() ? "" : files.front();
  throw std::runtime_error(where + "several files may be " + what + "; choose with " + option + ": " +
                           List(files));
}

// Bags are one recording between them, which RequireOneRecording looks at; of other files one has the events.
std::vector<std::string> EventsOf(const Sorted& sorted, const std::string& where) {
  std::vector<std::string> all = sorted.events;
  all.insert(all.end(), sorted.bags.begin(), sorted.bags.end());
  if (!sorted.events.empty() && all.size() > 1) {
    throw std::runtime_error(where + "several files may be events, of different recordings: " + List(all) +
                             "; import each by itself: evit import FILE --out LOG (streams of another file: "
                             "--imu FILE, --truth FILE)");
  }
  return all;
}

// Text is known by its name, so that estimates beside a recording are not taken for its truth.
// `others` is what only its contents tell.
void SortText(const fs::path& file, const std::string& folder, Sorted* named, Sorted* others) {
  const std::string path = file.string(), base = LowerCase(file.filename().string());
  const std::string name = LowerCase(path.substr(folder.size()));  // EuRoC's say it in folders: imu0/data.csv
  if (base == "events.txt" || base == "events.csv") return named->events.push_back(path);
  if (Contains(name, "truth") || Contains(name, "mocap") || Contains(name, ".gt.") ||
      Contains(name, "vicon") || Contains(name, "optitrack") || base.rfind("gt.", 0) == 0 ||
      base.rfind("gt_", 0) == 0)
    return named->truth.push_back(path);
  if (Contains(name, "imu")) return named->imu.push_back(path);
  const FileKind kind = KindOfFile(path);
  if (kind == FileKind::kEventTable) others->events.push_back(path);
  if (kind == FileKind::kImuTable) others->imu.push_back(path);
}

}  // namespace

RecordingFiles FindRecording(const std::string& folder, const std::string& given_imu,
                             const std::string& given_truth) {
  Sorted sorted, named, others;
  std::string packed;
  for (const fs::path& file : FilesBelow(folder)) {
    if (file.filename() == kBagMetadata) RequireListedParts(file.parent_path().string());
    const std::string path = file.string();
    if (Contains(path.substr(folder.size()), "right") || IsPicture(file)) continue;
    RefusePackedPart(file);
    if (IsText(file)) {
      SortText(file, folder, &named, &others);
      continue;
    }
    const FileKind kind = KindOfFile(path);
    if (kind == FileKind::kNone && IsPacked(file) && packed.empty()) packed = path;
    if (kind == FileKind::kBag) sorted.bags.push_back(path);
    if (kind == FileKind::kH5Events || kind == FileKind::kEvents) sorted.events.push_back(path);
    if (kind == FileKind::kStreams) sorted.beside.push_back(path);
  }
  // A file of events of its own format says more than text, and a name more than what text looks like.
  if (sorted.events.empty() && sorted.bags.empty())
    sorted.events = named.events.empty() ? others.events : named.events;
  sorted.imu = named.imu.empty() ? others.imu : named.imu;
  sorted.truth = named.truth;
  const std::string where = folder + ": ";
  RecordingFiles found;
  found.events = EventsOf(sorted, where);
  if (found.events.empty()) {
    const std::string other = packed.empty() ? "" : "; " + packed + ": " + OtherContents(packed);
    throw std::runtime_error(where + "holds no events in any format that is recognised" +
                             (other.empty() ? "; name the file" : other));
  }
  found.events.insert(found.events.end(), sorted.beside.begin(), sorted.beside.end());
  found.imu = given_imu.empty() ? OnlyOne(sorted.imu, where, "the IMU's", "--imu") : given_imu;
  found.truth = given_truth.empty() ? OnlyOne(sorted.truth, where, "the truth", "--truth") : given_truth;
  return found;
}

RecordingFiles SortRecording(const std::vector<std::string>& paths, const std::string& given_imu,
                             const std::string& given_truth) {
  Sorted sorted;
  for (const std::string& path : paths) {
    if (!fs::exists(path)) throw std::runtime_error(path + ": there is no such file or folder");
    switch (fs::is_directory(path) ? FileKind::kBag : KindOfFile(path)) {
      case FileKind::kBag:
        sorted.bags.push_back(path);
        break;
      case FileKind::kH5Events:
      case FileKind::kEvents:
      case FileKind::kEventTable:
        sorted.events.push_back(path);
        break;
      case FileKind::kStreams:
        sorted.beside.push_back(path);
        break;
      case FileKind::kImuTable:
        sorted.imu.push_back(path);
        break;
      case FileKind::kPoseTable:
        sorted.truth.push_back(path);
        break;
      case FileKind::kNone:
        const std::string other = OtherContents(path);
        throw std::runtime_error(
            path + ": " +
            (other.empty() ? "holds neither events nor an IMU nor poses that can be read" : other));
    }
  }
  RecordingFiles found;
  found.events = EventsOf(sorted, "");
  if (found.events.empty()) throw std::runtime_error(List(paths) + ": none of these holds events");
  found.events.insert(found.events.end(), sorted.beside.begin(), sorted.beside.end());
  found.imu = given_imu.empty() ? OnlyOne(sorted.imu, "", "the IMU's", "--imu") : given_imu;
  found.truth = given_truth.empty() ? OnlyOne(sorted.truth, "", "the truth", "--truth") : given_truth;
  return found;
}

}  // namespace evit::formats
