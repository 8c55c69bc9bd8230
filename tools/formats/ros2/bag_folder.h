#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/formats/ros/message_store.h"

namespace evit::formats {

/// The bags of one recording as one: the parts that a recorder splits a long one into, or files of different
/// topics. Parts come one after the other in order of time.
class BagFolder : public MessageStore {
 public:
  explicit BagFolder(std::vector<std::unique_ptr<MessageStore>> parts);
  std::string name() const override;
  std::string container() const override { return parts_.front()->container(); }
  bool cdr() const override { return parts_.front()->cdr(); }
  const std::vector<RosTopic>& topics() const override { return topics_; }
  std::unique_ptr<MessagePass> Read(const std::set<std::string>& topics) const override;
  std::size_t n_files() const override { return spans_.size(); }
  std::vector<BagPart> Parts() const override { return spans_; }

 private:
  void SortByTime();

  std::vector<std::unique_ptr<MessageStore>> parts_;
  std::vector<BagPart> spans_;
  std::vector<RosTopic> topics_;
};

/// Opens one ROS 2 bag: a file, or the folder that ros2 bag makes, with all its parts. Null where it is
/// neither.
std::unique_ptr<MessageStore> OpenRos2Bag(const std::string& path);

}  // namespace evit::formats
