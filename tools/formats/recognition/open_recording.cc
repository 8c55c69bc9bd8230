#include "tools/formats/recognition/open_recording.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "common/events/known_sensors.h"
#include "tools/formats/aedat/aedat4_recording.h"
#include "tools/formats/aedat/aedat_recording.h"
#include "tools/formats/bag/cut_bag.h"
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
    "(.npy, .npz), text (t x y p); evit import vector and rpg read folders of VECtor and RPG";

// A choice that is not looked at would be a wrong stream taken in silence.
void RequireNoChoice(const std::string& path, const std::string& events) {
  if (events.empty()) return;
  throw std::runtime_error(path + ": --events-topic " + events +
                           ": its format holds one stream of events; leave the option out");
}

std::unique_ptr<Recording> OpenFile(const std::string& path, const StreamChoice& choice) {
  if (!std::filesystem::exists(path)) throw std::runtime_error(path + ": there is no such file");
  if (!std::filesystem::is_regular_file(path))
    throw std::runtime_error(path + ": is not a file of events; " + kKnown);
  if (Aedat4Recording::Recognises(path))
    return std::make_unique<Aedat4Recording>(path, choice.events, choice.imu, choice.take_events);
  if (NpyRecording::Recognises(path)) return std::make_unique<NpyRecording>(path, choice.events);
  RequireNoChoice(path, choice.events);
  if (RawRecording::Recognises(path)) return std::make_unique<RawRecording>(path);
  if (AedatRecording::Recognises(path)) return std::make_unique<AedatRecording>(path);
  if (TextRecording::Recognises(path)) return std::make_unique<TextRecording>(path);
  const std::string other = OtherContents(path);
  if (!other.empty()) throw std::runtime_error(path + ": " + other);
  throw std::runtime_error(path + ": its contents are of no format that is recognised; " + kKnown);
}

std::unique_ptr<MessageStore> OpenRos2Bags(const std::vector<std::string>& paths) {
  std::vector<std::unique_ptr<MessageStore>> bags;
  for (const std::string& path : paths) {
    auto bag = OpenRos2Bag(path);
    if (!bag && bags.empty()) return nullptr;
    if (!bag) throw std::runtime_error(path + ": is not a ROS 2 bag, unlike " + paths.front());
    bags.push_back(std::move(bag));
  }
  if (bags.size() == 1) return std::move(bags.front());
  return std::make_unique<BagFolder>(std::move(bags));
}

// Several bags are one recording: of several topics, or one after the other. Null where they are none.
std::unique_ptr<MessageStore> OpenBags(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    if (!std::filesystem::exists(path)) throw std::runtime_error(path + ": there is no such file or folder");
  }
  const auto is_ros1 = [](const std::string& path) {
    return std::filesystem::is_regular_file(path) && RosbagStore::Recognises(path);
  };
  if (!is_ros1(paths.front())) return OpenRos2Bags(paths);
  for (const std::string& path : paths) {
    if (!is_ros1(path)) throw std::runtime_error(path + ": is not a ROS 1 bag, unlike " + paths.front());
  }
  if (std::none_of(paths.begin(), paths.end(), CutBag::Recognises))
    return std::make_unique<RosbagStore>(paths);  // merged by their indices, which a cut one does not have
  std::vector<std::unique_ptr<MessageStore>> bags;
  for (const std::string& path : paths) {
    if (CutBag::Recognises(path))
      bags.push_back(std::make_unique<CutBag>(path));
    else
      bags.push_back(std::make_unique<RosbagStore>(std::vector<std::string>{path}));
  }
  if (bags.size() == 1) return std::move(bags.front());
  return std::make_unique<BagFolder>(std::move(bags));
}

}  // namespace

std::unique_ptr<Recording> OpenRecording(const std::vector<std::string>& paths, const StreamChoice& choice) {
  if (auto bags = OpenBags(paths))
    return std::make_unique<RosRecording>(
        std::move(bags), RosTopics{choice.events, choice.imu, choice.truth, choice.truth_frame,
                                   choice.take_events, choice.take_imu, choice.take_truth});
  if (H5Recording::Recognises(paths.front())) return std::make_unique<H5Recording>(paths, choice.events);
  if (paths.size() != 1)
    throw std::runtime_error(paths[1] + ": a recording of the format of " + paths.front() +
                             " is one file; the IMU and truth of others are given with --imu and --truth");
  return OpenFile(paths.front(), choice);
}

bool IsRecording(const std::string& path) {
  if (OpenRos2Bags({path})) return true;
  return std::filesystem::is_regular_file(path) &&
         (RosbagStore::Recognises(path) || H5Recording::Recognises(path) || RawRecording::Recognises(path) ||
          Aedat4Recording::Recognises(path) || AedatRecording::Recognises(path) ||
          NpyRecording::Recognises(path));
}

bool HasTruthTopics(const std::string& path) {
  if (!std::filesystem::exists(path)) throw std::runtime_error(path + ": there is no such file or folder");
  const std::unique_ptr<MessageStore> bags = OpenRos2Bags({path});
  return bags != nullptr || (std::filesystem::is_regular_file(path) && RosbagStore::Recognises(path));
}

bool HasImuTopics(const std::string& path) {
  return HasTruthTopics(path) ||
         (std::filesystem::is_regular_file(path) && Aedat4Recording::Recognises(path));
}

void MeasureSize(Recording* recording, int* width, int* height) {
  constexpr int kLargest = 8192;         // pixels; beyond it is a damaged number
  constexpr std::int64_t kFew = 10'000;  // of so many events one may be such
  const std::unique_ptr<EventSource> events = recording->Events(kLargest, kLargest);
  EventArray piece;
  std::vector<std::int64_t> columns(kLargest, 0), rows(kLargest, 0);
  std::int64_t n = 0;
  while (events->Read(&piece)) {
    for (const std::uint16_t x : piece.x) ++columns[x];
    for (const std::uint16_t y : piece.y) ++rows[y];
    n += static_cast<std::int64_t>(piece.size());
  }
  if (n == 0) {
    const std::string dropped = DropText(events->dropped(), "events");
    throw std::runtime_error(events->name() + ": holds no event" + (dropped.empty() ? "" : "; " + dropped));
  }
  const auto extent = [&](const std::vector<std::int64_t>& counts) {
    std::int64_t beyond = 0;
    int size = kLargest;
    while (beyond + counts[static_cast<std::size_t>(size) - 1] <= n / kFew)
      beyond += counts[static_cast<std::size_t>(--size)];
    return size;
  };
  *width = extent(columns);
  *height = extent(rows);
  for (const auto& [w, h] : kKnownSensors) {
    if (*width == w + 1 && *height == h + 1 && columns[0] + rows[0] == 0) {
      throw std::runtime_error(
          events->name() + ": columns and rows seem to be counted from 1, up to " + std::to_string(w) + "x" +
          std::to_string(h) + "; EVIT counts from 0: subtract 1 from both, or give --size " +
          std::to_string(*width) + "x" + std::to_string(*height) + " if the sensor is so large");
    }
  }
  const auto known = [](int w, int h) {
    return std::find(std::begin(kKnownSensors), std::end(kKnownSensors), std::pair(w, h)) !=
           std::end(kKnownSensors);
  };
  if (*height > *width && known(*height, *width)) {
    throw std::runtime_error(
        events->name() + ": columns and rows seem to be swapped: x reaches " + std::to_string(*width - 1) +
        " and y " + std::to_string(*height - 1) + ", but sensors have " + std::to_string(*height) + "x" +
        std::to_string(*width) +
        " pixels; swap them (text: name the columns t y x p in the first line), or give --size " +
        std::to_string(*width) + "x" + std::to_string(*height) + " if it is so");
  }
  if (const auto sensor = SmallestKnownSensor(*width, *height)) std::tie(*width, *height) = *sensor;
}

}  // namespace evit::formats
