#pragma once

#include <memory>
#include <string>

#include "tools/formats/frames/frame_source.h"
#include "tools/formats/ros/message_store.h"

namespace evit::formats {

/// The images of one topic of a bag (sensor_msgs/Image, CompressedImage), stamped by their headers.
class RosFrames : public FrameSource {
 public:
  /// Reads all stamps. Throws std::runtime_error naming bag and option: no images, several topics of them.
  RosFrames(std::unique_ptr<MessageStore> store, const std::string& topic, bool depth);

  StoredPicture Fetch(std::size_t k) override;

 private:
  std::unique_ptr<MessageStore> store_;
  RosTopic topic_;
  std::unique_ptr<MessagePass> pass_;
  std::size_t next_ = 0;  // of the pass
};

}  // namespace evit::formats
