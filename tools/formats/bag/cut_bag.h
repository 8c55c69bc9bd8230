#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/formats/ros/message_store.h"

namespace evit::formats {

/// A bag of ROS 1 without its index, because it was cut off or recording was not ended: its chunks one after
/// the other up to the first that is not whole. By the published format 2.0 (wiki.ros.org/Bags/Format/2.0).
class CutBag : public MessageStore {
 public:
  /// Whether a file that begins as a bag has no index, or ends before or within it.
  static bool Recognises(const std::string& path);

  /// Reads it through once for its topics. Throws std::runtime_error naming the file: no whole chunk,
  /// damaged.
  explicit CutBag(const std::string& path);
  std::string name() const override { return path_; }
  std::string container() const override { return "ROS 1 bag"; }
  bool cdr() const override { return false; }
  const std::vector<RosTopic>& topics() const override { return topics_; }
  std::unique_ptr<MessagePass> Read(const std::set<std::string>& topics) const override;
  std::vector<BagPart> Parts() const override { return {part_}; }

 private:
  std::string path_;
  std::vector<RosTopic> topics_;
  BagPart part_;
};

}  // namespace evit::formats
