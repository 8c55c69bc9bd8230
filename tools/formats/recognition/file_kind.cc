#include "tools/formats/recognition/file_kind.h"

#include <stdexcept>

#include "tools/formats/aedat/aedat4_recording.h"
#include "tools/formats/aedat/aedat_recording.h"
#include "tools/formats/bag/rosbag_store.h"
#include "tools/formats/hdf5/h5_event_layout.h"
#include "tools/formats/hdf5/h5_recording.h"
#include "tools/formats/hdf5/h5_streams.h"
#include "tools/formats/numpy/npy_recording.h"
#include "tools/formats/prophesee/raw_recording.h"
#include "tools/formats/ros2/mcap_bag.h"
#include "tools/formats/ros2/sqlite_bag.h"
#include "tools/formats/tables/table_kind.h"

namespace evit::formats {
namespace {

FileKind KindOfH5(const std::string& path) {
  const H5File file(path);
  if (!FindEvents(file).empty()) return FileKind::kH5Events;
  ImportStreams streams;
  ReadH5Streams(file, &streams);
  return streams.imu.empty() && streams.truth.empty() ? FileKind::kNone : FileKind::kStreams;
}

FileKind KindOfNumpy(const std::string& path) {
  try {
    return NpyRecording(path).has_events() ? FileKind::kEvents : FileKind::kImuTable;
  } catch (const std::runtime_error&) {  // pictures, results, ...
    return FileKind::kNone;
  }
}

}  // namespace

FileKind KindOfFile(const std::string& path) {
  if (RosbagStore::Recognises(path) || SqliteBag::Recognises(path) || McapBag::Recognises(path))
    return FileKind::kBag;
  if (H5Recording::Recognises(path)) return KindOfH5(path);
  if (RawRecording::Recognises(path) || Aedat4Recording::Recognises(path) || AedatRecording::Recognises(path))
    return FileKind::kEvents;
  if (NpyRecording::Recognises(path)) return KindOfNumpy(path);
  switch (KindOfTable(path)) {
    case TableKind::kEvents:
      return FileKind::kEventTable;
    case TableKind::kImu:
      return FileKind::kImuTable;
    case TableKind::kPoses:
      return FileKind::kPoseTable;
    case TableKind::kNone:
      break;
  }
  return FileKind::kNone;
}

}  // namespace evit::formats
