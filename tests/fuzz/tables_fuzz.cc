// Text tables: VECtor's IMU file, trajectories (TUM) and their covariances, RPG's four files, lists of
// pictures. The first byte chooses.
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "common/evaluation/covariance_file.h"
#include "common/evaluation/trajectory.h"
#include "tests/fuzz/choice.h"
#include "tests/fuzz/temporary_file.h"
#include "tools/formats/frames/picture_list.h"
#include "tools/formats/rpg/rpg_events.h"
#include "tools/formats/rpg/rpg_tables.h"
#include "tools/formats/tables/stream_tables.h"
#include "tools/formats/vector/imu_file.h"

namespace {

void ReadPictures(const std::string& text) {
  evit::formats::PictureFolder folder;
  folder.pictures = {"img/00002.jpg", "img/1642661138.836530.png", "img/a.png"};
  folder.folder = folder.name = "img";
  for (const char* beside : {"", "img"}) {
    for (const bool stamped : {false, true}) {
      folder.stamped = stamped;
      const auto listed = evit::formats::ReadPictureList({text, "list", beside}, folder);
      if (listed && listed->empty()) std::abort();  // a list of no picture is none
    }
  }
}

void Read(int table, const std::string& path) {
  evit::formats::DropCounts dropped;
  switch (table) {
    case 0:
      evit::formats::ReadImuFile(path, &dropped);
      break;
    case 1:
      evit::ReadTum(path);
      break;
    case 2:
      evit::formats::ReadRpgImu(path, &dropped);
      break;
    case 3:
      evit::formats::ReadPoseTable(path, &dropped);
      break;
    case 4:
      evit::formats::ReadRpgCamera(path, 240, 180);
      break;
    case 6:
      evit::ReadCovariances(path);
      break;
    default: {
      evit::formats::RpgEvents reader(path, 240, 180);
      evit::EventArray events;
      while (reader.Read(&events)) {
      }
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  try {
    const int table = evit::fuzz::Choice(data[0], 8);
    if (table == 7) {
      ReadPictures({reinterpret_cast<const char*>(data + 1), size - 1});
      return 0;
    }
    const evit::fuzz::TemporaryFile file(data + 1, size - 1);
    Read(table, file.path());
  } catch (const std::runtime_error&) {
  }
  return 0;
}
