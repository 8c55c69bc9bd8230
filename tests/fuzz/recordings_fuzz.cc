// Recordings of other people's formats and live feeds, as far as our own parsers read them (HDF5, SQLite and
// whole ROS 1 bags are libraries'). The first byte chooses.
#include <functional>
#include <stdexcept>

#include "tests/fuzz/choice.h"
#include "tests/fuzz/temporary_file.h"
#include "tools/feed/feed_records.h"
#include "tools/formats/aedat/aedat4_recording.h"
#include "tools/formats/aedat/aedat_recording.h"
#include "tools/formats/bag/cut_bag.h"
#include "tools/formats/calibration_files/read_calibration.h"
#include "tools/formats/hdf5/ecf_chunk.h"
#include "tools/formats/import/ordered_events.h"
#include "tools/formats/numpy/npy_recording.h"
#include "tools/formats/prophesee/raw_recording.h"
#include "tools/formats/ros/message_types.h"
#include "tools/formats/ros/ros_recording.h"
#include "tools/formats/ros/transform_poses.h"
#include "tools/formats/ros2/mcap_bag.h"
#include "tools/formats/tables/stream_tables.h"
#include "tools/formats/tables/table_kind.h"

namespace {

using namespace evit::formats;

void ReadAll(Recording* recording) {
  recording->info();
  recording->Streams();
  const auto events = recording->Events(640, 480);
  OrderedEvents ordered(events.get());
  evit::EventArray piece;
  while (ordered.Read(&piece)) {
  }
}

void ReadMessages(const std::uint8_t* data, std::size_t size, bool cdr) {
  const std::function<void()> readers[] = {[&] {
                                             evit::EventArray events;
                                             GetEventArray(RosCursor(data, size, cdr), &events);
                                           },
                                           [&] {
                                             evit::EventArray events;
                                             EventPacketDecoder().Decode(
                                                 GetEventPacket(RosCursor(data, size, cdr)), &events);
                                           },
                                           [&] {
                                             RosCursor message(data, size, cdr);
                                             GetImu(&message);
                                           },
                                           [&] {
                                             RosCursor message(data, size, cdr);
                                             GetPose(kPoseTypes[2], &message);
                                           },
                                           [&] { TransformPoses().Add(RosCursor(data, size, cdr)); }};
  for (const auto& read : readers) {
    try {
      read();
    } catch (const std::runtime_error&) {
    }
  }
}

// A live feed, in two pieces.
void ReadRecords(const std::uint8_t* data, std::size_t size) {
  evit::feed::RecordParser parser;
  evit::EventArray events;
  std::vector<evit::ImuSample> imu;
  const std::size_t first = size > 0 ? data[0] % (size + 1) : 0;
  parser.Parse(data, first, &events, &imu);
  parser.Parse(data + first, size - first, &events, &imu);
}

// The only HDF5 filter that is ours.
void ReadEcf(const std::uint8_t* data, std::size_t size) {
  std::vector<H5Event> events(EcfEvents(data, size));
  DecodeEcf(data, size, events.data());
}

void Read(int which, const std::uint8_t* data, std::size_t size) {
  const evit::fuzz::TemporaryFile file(data, size);
  DropCounts dropped;
  switch (which) {
    case 0: {
      RawRecording recording(file.path());
      return ReadAll(&recording);
    }
    case 1: {
      Aedat4Recording recording(file.path());
      return ReadAll(&recording);
    }
    case 2: {
      AedatRecording recording(file.path());
      return ReadAll(&recording);
    }
    case 3: {
      RosRecording recording(std::make_unique<McapBag>(file.path()), {});
      return ReadAll(&recording);
    }
    case 4:
    case 5:
      return ReadMessages(data, size, which == 4);
    case 6:
      ReadImuTable(file.path(), &dropped);
      return;
    case 7:
      ReadPoseTable(file.path(), &dropped);
      return;
    case 9:
      return ReadEcf(data, size);
    case 10: {
      NpyRecording recording(file.path());
      if (!recording.has_events()) return;
      return ReadAll(&recording);
    }
    case 11:
      ReadCalibration({file.path()}, {346, 260, "left", evit::SE3()});
      return;
    case 12:
      KindOfTable(file.path());
      return;
    case 13: {
      RosRecording recording(std::make_unique<CutBag>(file.path()), {});
      return ReadAll(&recording);
    }
    default:
      ReadRecords(data, size);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  try {
    Read(evit::fuzz::Choice(data[0], 14), data + 1, size - 1);
  } catch (const std::runtime_error&) {
  }
  return 0;
}
