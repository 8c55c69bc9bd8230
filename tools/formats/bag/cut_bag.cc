#include "tools/formats/bag/cut_bag.h"

#include <stdexcept>
#include <utility>

#include "tools/formats/bag/bag_chunks.h"

namespace evit::formats {
namespace {

Utime RecordedAt(const BagRecord& record) {
  const std::uint64_t time = record.Number("time");  // seconds, then nanoseconds
  return static_cast<Utime>((time & 0xFFFFFFFF) * kMicrosPerSecond + (time >> 32) / 1000);
}

// Messages in the order in which they were written, with the topics that the bag names before them.
class CutBagPass : public MessagePass {
 public:
  /// `topics`: of interest; null: all.
  CutBagPass(const std::string& path, const std::set<std::string>* topics) : chunks_(path) {
    if (topics != nullptr) topics_ = *topics;
    all_ = topics == nullptr;
  }

  bool Next(RosMessage* message) override {
    while (true) {
      BagRecord record;
      while (at_ < contents_.size() && NextRecord(contents_.data(), contents_.size(), &at_, &record)) {
        const auto connection = static_cast<std::uint32_t>(record.Number("conn"));
        if (record.Op() == BagRecord::kConnection) Connect(connection, record);
        if (record.Op() != BagRecord::kMessage) continue;
        const auto topic = connections_.find(connection);
        if (topic == connections_.end() || (!all_ && topics_.count(topic->second) == 0)) continue;
        *message = {topic->second, record.data, record.size};
        time_ = RecordedAt(record);
        return true;
      }
      if (at_ < contents_.size())
        chunks_.file().Fail("a chunk before byte " + std::to_string(chunks_.file().position()) +
                            " is damaged");
      at_ = 0;
      if (!chunks_.Next(&contents_)) return false;
    }
  }
  double share() const override { return chunks_.file().share(); }
  bool cut_off() const override { return true; }
  double lost_share() const override {
    const auto whole = static_cast<double>(chunks_.index_position()),
               here = static_cast<double>(chunks_.file().size());
    return whole > here ? 1 - here / whole : 0;
  }
  const std::map<std::string, std::string>& types() const { return types_; }  // of the topics so far
  Utime time() const { return time_; }  // at which the message was recorded

 private:
  void Connect(std::uint32_t id, const BagRecord& record) {
    const std::string topic = record.Text("topic");
    connections_[id] = topic;
    BagRecord described;
    if (ParseFields(record.data, record.size, &described)) types_[topic] = described.Text("type");
  }

  BagChunks chunks_;
  std::set<std::string> topics_;
  bool all_ = false;
  std::map<std::uint32_t, std::string> connections_;
  std::map<std::string, std::string> types_;
  std::vector<std::uint8_t> contents_;
  std::size_t at_ = 0;
  Utime time_ = 0;
};

}  // namespace

bool CutBag::Recognises(const std::string& path) {
  const BagChunks chunks(path);
  if (chunks.index_position() == 0 || chunks.index_position() >= chunks.file().size()) return true;
  // The index, connections and chunks, ends with the file.
  ByteFile file(path);
  file.Seek(chunks.index_position());
  const std::uint64_t left = file.size() - chunks.index_position();
  if (left > kMaxMessage) return false;
  const std::uint8_t* index = file.Take(left, "index");
  BagRecord record;
  std::size_t at = 0;
  while (at < left && NextRecord(index, left, &at, &record)) {
  }
  return at < left;
}

CutBag::CutBag(const std::string& path) : path_(path), part_{path, {}, true} {
  CutBagPass pass(path, nullptr);
  RosMessage message;
  while (pass.Next(&message)) part_.Cover(message.topic, pass.time());
  for (const auto& [name, type] : pass.types()) topics_.push_back({name, type});
  if (part_.topics.empty())
    throw std::runtime_error(path + ": was cut off before its first whole chunk; copy it again");
}

std::unique_ptr<MessagePass> CutBag::Read(const std::set<std::string>& topics) const {
  return std::make_unique<CutBagPass>(path_, &topics);
}

}  // namespace evit::formats
