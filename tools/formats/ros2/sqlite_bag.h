#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/formats/ros/message_store.h"

namespace evit::formats {

/// A bag of ROS 2 in SQLite (rosbag2's .db3): tables `topics` and `messages`. One that is shorter than its
/// header says was cut off: its messages are read up to the first that is not whole.
class SqliteBag : public MessageStore {
 public:
  static bool Recognises(const std::string& path);

  /// Throws std::runtime_error naming the file where it is no such database.
  explicit SqliteBag(const std::string& path);
  std::string name() const override { return path_; }
  std::string container() const override { return "ROS 2 bag (SQLite)"; }
  bool cdr() const override { return true; }
  const std::vector<RosTopic>& topics() const override { return topics_; }
  std::unique_ptr<MessagePass> Read(const std::set<std::string>& topics) const override;
  std::vector<BagPart> Parts() const override;

 private:
  std::string path_;
  double lost_share_;  // of the file; 0: it is whole
  std::vector<RosTopic> topics_;
  std::map<std::int64_t, std::string> ids_;  // names of the topics
};

}  // namespace evit::formats
