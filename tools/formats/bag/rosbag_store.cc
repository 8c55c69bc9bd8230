#include "tools/formats/bag/rosbag_store.h"

#include <cstring>

#include "tools/formats/bag/bag_reader.h"
#include "tools/formats/import/byte_file.h"

namespace evit::formats {
namespace {

constexpr char kMagic[] = "#ROSBAG V2.0\n";

class RosbagPass : public MessagePass {
 public:
  RosbagPass(const BagFiles& files, const std::set<std::string>& topics) : reader_(files, topics) {}

  bool Next(RosMessage* message) override {
    if (!reader_.Next()) return false;
    message->topic = reader_.topic();
    reader_.Decoded([message](const std::uint8_t* data, std::size_t size) {
      message->data = data;
      message->size = size;
    });
    return true;
  }
  double share() const override { return reader_.share(); }

 private:
  BagReader reader_;
};

}  // namespace

bool RosbagStore::Recognises(const std::string& path) {
  constexpr std::size_t n = sizeof kMagic - 1;
  ByteFile file(path);
  return file.Fill(n) && file.available() >= n && std::memcmp(file.data(), kMagic, n) == 0;
}

RosbagStore::RosbagStore(const std::vector<std::string>& paths) : files_(paths) {
  for (const auto& [name, type] : files_.types()) topics_.push_back({name, type});
}

std::unique_ptr<MessagePass> RosbagStore::Read(const std::set<std::string>& topics) const {
  return std::make_unique<RosbagPass>(files_, topics);
}

}  // namespace evit::formats
