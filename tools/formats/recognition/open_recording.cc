#include "tools/formats/recognition/open_recording.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "tools/formats/aedat/aedat4_recording.h"
#include "tools/formats/aedat/aedat_recording.h"
#include "tools/formats/bag/rosbag_store.h"
#include "tools/formats/hdf5/h5_recording.h"
#include "tools/formats/numpy/npy_recording.h"
#include "tools/formats/prophesee/raw_recording.h"
#include "tools/formats/recognition/other_contents.h"
#include "tools/formats/ros/ros_recording.h"
#include "tools/formats/ros2/bag_folder.h"
#include "tools/formats/rpg/text_recording.h"

namespace evit::formats {
namespace {

constexpr char kKnown[] =
    "known are Metavision RAW (EVT 2.0, 2.1, 3.0) and DAT, AEDAT 2.0, 3.1 and 4.0, bags of ROS 1 and of "
    "ROS 2 (SQLite, MCAP), HDF5 of DSEC, TUM-VIE, M3ED, MVSEC, EDS and Prophesee, numpy arrays "
    "(.npy), text (t x y p); evit import vector and rpg read folders of VECtor and RPG";

std::unique_ptr<Recording> OpenFile(const std::string& path) {
  if (!std::filesystem::exists(path)) throw std::runtime_error(path + ": there is no such file");
  if (!std::filesystem::is_regular_file(path))
    throw std::runtime_error(path + ": is no file of events; " + kKnown);
  if (RawRecording::Recognises(path)) return std::make_unique<RawRecording>(path);
  if (Aedat4Recording::Recognises(path)) return std::make_unique<Aedat4Recording>(path);
  if (AedatRecording::Recognises(path)) return std::make_unique<AedatRecording>(path);
  if (TextRecording::Recognises(path)) return std::make_unique<TextRecording>(path);
  if (NpyRecording::Recognises(path)) return std::make_unique<NpyRecording>(path);
  const std::string other = OtherContents(path);
  if (!other.empty()) throw std::runtime_error(path + ": " + other);
  throw std::runtime_error(path + ": its contents are of no format that is recognised; " + kKnown);
}

std::unique_ptr<MessageStore> OpenRos2Bags(const std::vector<std::string>& paths) {
  std::vector<std::unique_ptr<MessageStore>> bags;
  for (const std::string& path : paths) {
    auto bag = OpenRos2Bag(path);
    if (!bag && bags.empty()) return nullptr;
    if (!bag) throw std::runtime_error(path + ": is no bag of ROS 2, unlike " + paths.front());
    bags.push_back(std::move(bag));
  }
  return bags.size() == 1 ? std::move(bags.front()) : std::make_unique<BagFolder>(std::move(bags));
}

// Several bags are one recording: of several topics, or one after the other. Null where they are none.
std::unique_ptr<MessageStore> OpenBags(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    if (!std::filesystem::exists(path)) throw std::runtime_error(path + ": there is no such file or folder");
  }
  const bool is_file = std::filesystem::is_regular_file(paths.front());
  if (is_file && RosbagStore::Recognises(paths.front())) return std::make_unique<RosbagStore>(paths);
  return OpenRos2Bags(paths);
}

}  // namespace

std::unique_ptr<Recording> OpenRecording(const std::vector<std::string>& paths, const StreamChoice& choice) {
  if (auto bags = OpenBags(paths))
    return std::make_unique<RosRecording>(std::move(bags),
                                          RosTopics{choice.events, choice.imu, choice.truth});
  if (H5Recording::Recognises(paths.front())) return std::make_unique<H5Recording>(paths, choice.events);
  if (paths.size() != 1)
    throw std::runtime_error(paths[1] + ": a recording of the format of " + paths.front() + " is one file");
  return OpenFile(paths.front());
}

bool IsRecording(const std::string& path) {
  if (OpenRos2Bags({path})) return true;
  return std::filesystem::is_regular_file(path) &&
         (RosbagStore::Recognises(path) || H5Recording::Recognises(path) || RawRecording::Recognises(path) ||
          Aedat4Recording::Recognises(path) || AedatRecording::Recognises(path) ||
          NpyRecording::Recognises(path));
}

void MeasureSize(Recording* recording, int* width, int* height) {
  constexpr int kAny = 1 << 16;
  const std::unique_ptr<EventSource> events = recording->Events(kAny, kAny);
  EventArray piece;
  std::uint16_t x = 0, y = 0;
  bool any = false;
  while (events->Read(&piece)) {
    any = true;
    x = std::max(x, *std::max_element(piece.x.begin(), piece.x.end()));
    y = std::max(y, *std::max_element(piece.y.begin(), piece.y.end()));
  }
  if (!any) throw std::runtime_error(events->name() + ": holds no event");
  constexpr int kSensors[][2] = {{128, 128}, {240, 180}, {304, 240}, {320, 320},
                                 {346, 260}, {640, 480}, {1280, 720}};
  *width = x + 1;
  *height = y + 1;
  for (const auto& sensor : kSensors) {
    if (x >= sensor[0] || y >= sensor[1]) continue;
    *width = sensor[0];
    *height = sensor[1];
    return;
  }
}

}  // namespace evit::formats
