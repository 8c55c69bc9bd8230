#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/formats/bag/bag_files.h"
#include "tools/formats/ros/message_store.h"

namespace evit::formats {

/// Bags of ROS 1, merged by time, as RosRecording reads them.
class RosbagStore : public MessageStore {
 public:
  static bool Recognises(const std::string& path);

  /// Throws as BagFiles does.
  explicit RosbagStore(const std::vector<std::string>& paths);
  std::string name() const override { return files_.Names(); }
  std::string container() const override { return "ROS 1 bag"; }
  bool cdr() const override { return false; }
  const std::vector<RosTopic>& topics() const override { return topics_; }
  std::unique_ptr<MessagePass> Read(const std::set<std::string>& topics) const override;
  std::size_t n_files() const override { return files_.bags().size(); }
  std::vector<BagPart> Parts() const override { return files_.Parts(); }

 private:
  BagFiles files_;
  std::vector<RosTopic> topics_;
};

}  // namespace evit::formats
