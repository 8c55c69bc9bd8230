#include "tools/formats/ros2/mcap_bag.h"

#include <cstring>
#include <stdexcept>

#include "tools/formats/import/byte_file.h"
#include "tools/formats/ros2/mcap_records.h"
#include "tools/formats/ros2/packed_message.h"

namespace evit::formats {
namespace {

constexpr std::uint8_t kMagic[] = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
constexpr std::size_t kFooterBytes = 9 + 8 + 8 + 4;  // record header, two positions, checksum

struct Channel {
  std::uint64_t id = 0, schema = 0;
  std::string topic, encoding;
};

Channel ReadChannel(const McapRecord& record) {
  McapFields fields(record);
  Channel channel;
  channel.id = fields.Number(2);
  channel.schema = fields.Number(2);
  channel.topic = fields.Text();
  channel.encoding = fields.Text();
  return channel;
}

// Schemas and channels of one file.
struct Contents {
  std::map<std::uint64_t, std::string> schemas;
  std::map<std::uint64_t, Channel> channels;

  void Add(const McapRecord& record) {
    if (record.type == McapRecord::kSchema) {
      McapFields fields(record);
      const std::uint64_t id = fields.Number(2);
      schemas[id] = fields.Text();
    } else if (record.type == McapRecord::kChannel) {
      const Channel channel = ReadChannel(record);
      channels[channel.id] = channel;
    }
  }
};

// The summary at the end repeats them all; false where there is none.
bool ReadSummary(const std::string& path, Contents* contents) {
  ByteFile file(path);
  if (file.size() < kFooterBytes + 2 * sizeof kMagic) return false;
  file.Seek(file.size() - sizeof kMagic - kFooterBytes);
  const std::uint8_t* footer = file.Take(kFooterBytes + sizeof kMagic, "footer");
  if (footer[0] != McapRecord::kFooter || std::memcmp(footer + kFooterBytes, kMagic, sizeof kMagic) != 0)
    return false;
  std::uint64_t begin;
  std::memcpy(&begin, footer + 9, sizeof begin);
  const std::uint64_t end = file.size() - sizeof kMagic - kFooterBytes;
  if (begin == 0 || begin > end || end - begin > (1U << 28)) return false;
  file.Seek(begin);
  McapFields summary(file.Take(end - begin, "summary"), static_cast<std::size_t>(end - begin));
  while (summary.left() > 0) {
    McapRecord record;
    record.type = static_cast<std::uint8_t>(summary.Number(1));
    const std::uint64_t size = summary.Number(8);
    record.data = summary.Take(size);
    record.size = static_cast<std::size_t>(size);
    contents->Add(record);
  }
  return !contents->channels.empty();
}

class McapPass : public MessagePass {
 public:
  McapPass(const std::string& path, const std::set<std::string>& topics) : records_(path), topics_(topics) {}

  bool Next(RosMessage* message) override {
    McapRecord record;
    while (records_.Next(&record)) {
      try {
        if (record.type == McapRecord::kChannel) {
          const Channel channel = ReadChannel(record);
          if (topics_.count(channel.topic) > 0) channels_[channel.id] = channel.topic;
        } else if (record.type == McapRecord::kMessage) {
          McapFields fields(record);
          const auto channel = channels_.find(fields.Number(2));
          if (channel == channels_.end()) continue;
          fields.Number(4);  // sequence
          recorded_ = static_cast<Utime>(fields.Number(8) / 1000);
          fields.Number(8);  // time of sending
          message->topic = channel->second;
          message->size = fields.left();
          message->data = fields.Take(message->size);
          packed_.Unpack(message);
          return true;
        }
      } catch (const std::runtime_error& error) {
        records_.file().Fail(error.what());
      }
    }
    return false;
  }
  double share() const override { return records_.file().share(); }
  bool cut_off() const override { return records_.cut_off(); }
  Utime recorded() const { return recorded_; }  // of the last message, in us

 private:
  McapRecords records_;
  std::set<std::string> topics_;
  PackedMessages packed_;
  std::map<std::uint64_t, std::string> channels_;  // those asked for
  Utime recorded_ = 0;
};

}  // namespace

bool McapBag::Recognises(const std::string& path) {
  ByteFile file(path);
  return file.Fill(sizeof kMagic) && file.available() >= sizeof kMagic &&
         std::memcmp(file.data(), kMagic, sizeof kMagic) == 0;
}

McapBag::McapBag(const std::string& path) : path_(path) {
  Contents contents;
  try {
    if (!ReadSummary(path, &contents)) {
      McapRecords records(path);
      McapRecord record;
      while (records.Next(&record)) contents.Add(record);
    }
  } catch (const std::runtime_error& error) {
    const std::string what = error.what();
    throw std::runtime_error(what.rfind(path, 0) == 0 ? what : path + ": " + what);
  }
  bool ros1 = false, ros2 = false;
  for (const auto& [id, channel] : contents.channels) {
    const std::string type = Ros1TypeName(contents.schemas[channel.schema]);
    const bool cdr = channel.encoding == "cdr", read = cdr || channel.encoding == "ros1";
    if (read) (cdr ? ros2 : ros1) = true;
    topics_.push_back(
        {channel.topic, read ? type : type + " as " + channel.encoding + ", which is not read"});
  }
  if (ros1 && ros2)
    throw std::runtime_error(path + ": mixes messages of ROS 1 and ROS 2, which cannot be read");
  cdr_ = !ros1;
}

std::vector<BagPart> McapBag::Parts() const {
  std::set<std::string> names;
  for (const RosTopic& topic : topics_) names.insert(topic.name);
  McapPass pass(path_, names);
  BagPart part{path_, {}};
  RosMessage message;
  while (pass.Next(&message)) part.Cover(message.topic, pass.recorded());
  return {part};
}

std::unique_ptr<MessagePass> McapBag::Read(const std::set<std::string>& topics) const {
  return std::make_unique<McapPass>(path_, topics);
}

}  // namespace evit::formats
