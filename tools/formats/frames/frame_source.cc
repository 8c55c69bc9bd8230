#include "tools/formats/frames/frame_source.h"

#include <filesystem>
#include <stdexcept>

#include "tools/formats/bag/rosbag_store.h"
#include "tools/formats/frames/file_frames.h"
#include "tools/formats/frames/ros_frames.h"
#include "tools/formats/ros2/bag_folder.h"

namespace evit::formats {

std::unique_ptr<FrameSource> OpenFrames(const std::string& path, const FrameSourceOptions& options) {
  if (std::filesystem::is_regular_file(path) && RosbagStore::Recognises(path)) {
    return std::make_unique<RosFrames>(std::make_unique<RosbagStore>(std::vector<std::string>{path}),
                                       options.topic, options.depth);
  }
  if (std::filesystem::exists(path)) {
    if (auto bag = OpenRos2Bag(path))
      return std::make_unique<RosFrames>(std::move(bag), options.topic, options.depth);
  }
  if (!options.topic.empty())
    throw std::runtime_error(path + ": is not a ROS bag, a topic (" + options.topic + ") means nothing");
  return std::make_unique<FileFrames>(OpenFileTree(path), path, options.depth);
}

}  // namespace evit::formats
