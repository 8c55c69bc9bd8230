#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/formats/ros/message_store.h"

namespace rosbag {
class Bag;
}

namespace evit::formats {

/// ROS 1 bags, opened together as one recording.
class BagFiles {
 public:
  /// Throws std::runtime_error naming the file: missing, no bag, cut off.
  explicit BagFiles(const std::vector<std::string>& paths);
  ~BagFiles();

  /// The topic of one of these types: `requested`, or, where that is empty, the only one there is. Empty
  /// where there is none and none is requested. Otherwise throws std::runtime_error that lists the topics and
  /// names `option`.
  template <std::size_t n>
  std::string FindTopic(const char* const (&types)[n], const std::string& requested,
                        const std::string& option) const {
    return FindTopic(std::vector<std::string>(types, types + n), requested, option);
  }

  const std::vector<std::unique_ptr<rosbag::Bag>>& bags() const { return bags_; }
  const std::map<std::string, std::string>& types() const { return types_; }  // of each topic
  std::vector<BagPart> Parts() const;                                         // what each file spans
  std::string Names() const;                                                  // of all files
  std::string Topics() const;                                                 // all topics with their types

 private:
  std::string FindTopic(const std::vector<std::string>& types, const std::string& requested,
                        const std::string& option) const;

  std::vector<std::unique_ptr<rosbag::Bag>> bags_;
  std::map<std::string, std::string> types_;  // topic to type
};

}  // namespace evit::formats
