#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/formats/ros/message_store.h"

namespace evit::formats {

/// An MCAP file (mcap.dev/spec) with messages of ROS 1 or ROS 2: plain, or in chunks without compression, of
/// LZ4 or of Zstandard. A file that was cut off is read as far as it goes.
class McapBag : public MessageStore {
 public:
  static bool Recognises(const std::string& path);

  /// Throws std::runtime_error naming the file: damaged, or topics serialized otherwise.
  explicit McapBag(const std::string& path);
  std::string name() const override { return path_; }
  std::string container() const override { return "MCAP"; }
  bool cdr() const override { return cdr_; }
  const std::vector<RosTopic>& topics() const override { return topics_; }
  std::unique_ptr<MessagePass> Read(const std::set<std::string>& topics) const override;
  std::vector<BagPart> Parts() const override;

 private:
  std::string path_;
  std::vector<RosTopic> topics_;
  bool cdr_ = true;
};

}  // namespace evit::formats
