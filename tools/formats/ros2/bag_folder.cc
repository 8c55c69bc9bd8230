#include "tools/formats/ros2/bag_folder.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <stdexcept>

#include "tools/formats/ros2/bag_metadata.h"
#include "tools/formats/ros2/mcap_bag.h"
#include "tools/formats/ros2/sqlite_bag.h"

namespace evit::formats {
namespace {

class FolderPass : public MessagePass {
 public:
  // Of parts without these topics nothing is read: that one of them is cut off does not matter.
  FolderPass(const std::vector<std::unique_ptr<MessageStore>>& parts, const std::set<std::string>& topics)
      : topics_(topics) {
    for (const auto& part : parts) {
      if (std::any_of(topics.begin(), topics.end(), [&](const std::string& t) { return Has(*part, t); }))
        parts_.push_back(part.get());
    }
  }
  bool Next(RosMessage* message) override {
    while (true) {
      if (pass_ && pass_->Next(message)) return true;
      if (pass_) NoteLoss(*parts_[next_ - 1]);
      if (next_ == parts_.size()) return pass_ = nullptr, false;
      pass_ = parts_[next_++]->Read(topics_);
    }
  }
  Loss LossOf(const std::string& topic) const override {
    const auto found = losses_.find(topic);
    return found != losses_.end() ? found->second : Loss{};
  }
  double share() const override {
    if (!pass_) return next_ > 0 ? 1 : 0;
    return (static_cast<double>(next_) - 1 + pass_->share()) / static_cast<double>(parts_.size());
  }

 private:
  static bool Has(const MessageStore& part, const std::string& topic) {
    const std::vector<RosTopic>& all = part.topics();
    return std::any_of(all.begin(), all.end(), [&](const RosTopic& t) { return t.name == topic; });
  }
  // At the end of a part: what it lost counts as its share of those that hold the topic.
  void NoteLoss(const MessageStore& part) {
    for (const std::string& topic : topics_) {
      if (!Has(part, topic)) continue;
      const auto n = std::count_if(parts_.begin(), parts_.end(),
                                   [&](const MessageStore* other) { return Has(*other, topic); });
      Loss& loss = losses_[topic];
      const Loss of_part = pass_->LossOf(topic);
      loss.cut_off = loss.cut_off || of_part.cut_off;
      loss.share += of_part.share / static_cast<double>(n);
    }
  }

  std::vector<const MessageStore*> parts_;
  std::set<std::string> topics_;
  std::unique_ptr<MessagePass> pass_;
  std::size_t next_ = 0;
  std::map<std::string, Loss> losses_;  // of each topic
};

std::unique_ptr<MessageStore> OpenFile(const std::string& path) {
  if (SqliteBag::Recognises(path)) return std::make_unique<SqliteBag>(path);
  if (McapBag::Recognises(path)) return std::make_unique<McapBag>(path);
  return nullptr;
}

}  // namespace

BagFolder::BagFolder(std::vector<std::unique_ptr<MessageStore>> parts) : parts_(std::move(parts)) {
  SortByTime();
  std::map<std::string, std::string> types;
  for (const auto& part : parts_) {
    if (part->cdr() != cdr())
      throw std::runtime_error(part->name() + ": is of another version of ROS than " +
                               parts_.front()->name());
    for (const RosTopic& topic : part->topics()) types[topic.name] = topic.type;
  }
  for (const auto& [name, type] : types) topics_.push_back({name, type});
}

void BagFolder::SortByTime() {
  std::vector<std::pair<Utime, std::size_t>> order;
  for (const auto& part : parts_) {
    Utime begin = std::numeric_limits<Utime>::max();
    for (BagPart& file : part->Parts()) {
      for (const auto& [topic, span] : file.topics) begin = std::min(begin, span.begin);
      spans_.push_back(std::move(file));
    }
    order.emplace_back(begin, order.size());
  }
  std::sort(order.begin(), order.end());
  std::vector<std::unique_ptr<MessageStore>> sorted;
  sorted.reserve(order.size());
  for (const auto& [begin, k] : order) sorted.push_back(std::move(parts_[k]));
  parts_ = std::move(sorted);
}

std::string BagFolder::name() const {
  std::string names;
  for (const auto& part : parts_) names += (names.empty() ? "" : ", ") + part->name();
  return names;
}

std::unique_ptr<MessagePass> BagFolder::Read(const std::set<std::string>& topics) const {
  return std::make_unique<FolderPass>(parts_, topics);
}

std::unique_ptr<MessageStore> OpenRos2Bag(const std::string& path) {
  if (!std::filesystem::is_directory(path)) return OpenFile(path);
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    const std::string extension = entry.path().extension().string();
    if (entry.is_regular_file() && (extension == ".db3" || extension == ".mcap"))
      files.push_back(entry.path().string());
    RefusePackedPart(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<std::unique_ptr<MessageStore>> parts;
  for (const std::string& file : files) {
    if (auto part = OpenFile(file)) parts.push_back(std::move(part));
  }
  if (parts.empty()) return nullptr;
  RequireListedParts(path);
  return parts.size() == 1 ? std::move(parts.front()) : std::make_unique<BagFolder>(std::move(parts));
}

}  // namespace evit::formats
