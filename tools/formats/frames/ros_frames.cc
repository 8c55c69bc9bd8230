#include "tools/formats/frames/ros_frames.h"

#include <stdexcept>
#include <utility>

#include "common/files/decimal_time.h"
#include "tools/formats/ros/ros_cursor.h"
#include "tools/formats/ros/topic_choice.h"

namespace evit::formats {
namespace {

constexpr char kImage[] = "sensor_msgs/Image", kCompressed[] = "sensor_msgs/CompressedImage";

StoredPicture GetImage(RosCursor message) {
  StoredPicture picture;
  message.Header();
  picture.height = message.Get<std::uint32_t>("height");
  picture.width = message.Get<std::uint32_t>("width");
  picture.encoding = message.Text("encoding");
  picture.big_endian = message.Get<std::uint8_t>("is_bigendian") != 0;
  picture.step = message.Get<std::uint32_t>("step");
  const auto n = message.Get<std::uint32_t>("data");
  const std::uint8_t* data = message.Take(n, "data");
  picture.bytes.assign(data, data + n);
  if (picture.encoding.empty()) throw std::runtime_error("encoding is empty");
  return picture;
}

StoredPicture GetCompressed(RosCursor message) {
  StoredPicture picture;
  message.Header();
  const std::string format = message.Text("format");
  auto n = message.Get<std::uint32_t>("data");
  const std::uint8_t* data = message.Take(n, "data");
  // compressed_depth_image_transport puts 12 bytes of its own before the PNG.
  constexpr std::uint32_t kDepthHeader = 12;
  if (format.find("compressedDepth") != std::string::npos && n > kDepthHeader)
    data += kDepthHeader, n -= kDepthHeader;
  picture.bytes.assign(data, data + n);
  return picture;
}

bool MeansDepth(const std::string& topic) { return topic.find("depth") != std::string::npos; }

// Where one of several topics is meant, those that say "depth" are told from the others.
RosTopic ChooseImages(const MessageStore& store, const std::string& requested, bool depth) {
  const std::vector<std::string> types = {kImage, kCompressed};
  if (requested.empty()) {
    std::vector<RosTopic> meant;
    for (const RosTopic& topic : store.topics()) {
      if ((topic.type == kImage || topic.type == kCompressed) && MeansDepth(topic.name) == depth)
        meant.push_back(topic);
    }
    if (meant.size() == 1) return meant.front();
  }
  const char* option = depth ? "--depth-topic" : "--topic";
  RosTopic topic = ChooseTopic(store, types, requested, option);
  if (topic.name.empty()) {
    throw std::runtime_error(store.name() +
                             ": no topic holds images (sensor_msgs/Image or CompressedImage); " +
                             "topics: " + TopicList(store));
  }
  return topic;
}

}  // namespace

RosFrames::RosFrames(std::unique_ptr<MessageStore> store, const std::string& topic, bool depth)
    : store_(std::move(store)), topic_(ChooseImages(*store_, topic, depth)) {
  pass_ = store_->Read({topic_.name});
  RosMessage message;
  while (pass_->Next(&message)) {
    const std::string name =
        store_->name() + ": " + topic_.name + ", message " + std::to_string(frames_.size() + 1);
    try {
      frames_.push_back(
          {name, DecimalSeconds(RosCursor(message.data, message.size, store_->cdr()).Header())});
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(name + ": " + error.what());
    }
  }
  if (frames_.empty()) throw std::runtime_error(store_->name() + ": " + topic_.name + " holds no message");
  pass_.reset();
}

StoredPicture RosFrames::Fetch(std::size_t k) {
  if (!pass_ || k < next_) {
    pass_ = store_->Read({topic_.name});
    next_ = 0;
  }
  RosMessage message;
  for (bool there = true; next_ <= k; ++next_) {
    there = pass_->Next(&message);
    if (!there) throw std::runtime_error(frames_.at(k).name + ": the bag ends before it");
  }
  try {
    const RosCursor cursor(message.data, message.size, store_->cdr());
    return topic_.type == kCompressed ? GetCompressed(cursor) : GetImage(cursor);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(frames_.at(k).name + ": " + error.what());
  }
}

}  // namespace evit::formats
