#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace evit::formats {

/// A picture as it is stored. decode_picture.h makes one of it.
struct StoredPicture {
  std::vector<std::uint8_t> bytes;
  // Of a ROS image ("mono8", "bgr8", ...), with its shape; empty: the bytes are those of a picture file.
  std::string encoding;
  std::uint32_t width = 0, height = 0, step = 0;  // pixels, pixels, bytes
  bool big_endian = false;
};

/// The pictures of one camera: files of a folder or of a zip archive, or a topic of a bag.
class FrameSource {
 public:
  struct Frame {
    std::string name;   // file, or bag with topic and number, for messages
    std::string stamp;  // decimal text of whatever unit, as it was found; empty: none
  };

  virtual ~FrameSource() = default;
  /// In the order of names (numbers in them by value), or of the list or topic.
  const std::vector<Frame>& frames() const { return frames_; }
  /// The k-th. Fast where k ascends; not to be called by two threads at once. Throws std::runtime_error
  /// naming file or message.
  virtual StoredPicture Fetch(std::size_t k) = 0;

 protected:
  std::vector<Frame> frames_;
};

struct FrameSourceOptions {
  std::string topic;   // of a bag; empty: the only one of images
  bool depth = false;  // depth images: other lists and topics are meant
};

/// Opens what the path is: a folder or zip archive of pictures (PNG, JPEG, BMP, TIFF, PGM), or a bag of ROS 1
/// or 2 with sensor_msgs/Image or CompressedImage. Stamps of files come from a list beside or above the
/// pictures (images.txt, rgb.txt, depth.txt, timestamp.txt, timestamps.txt, image_timestamps.txt, times.txt,
/// data.csv, left_images.txt, ...; ReadPictureList says what it may hold), else from the names, where these
/// hold numbers of ten digits or more that do not count. Throws std::runtime_error naming the path, what is
/// wrong and the remedy.
std::unique_ptr<FrameSource> OpenFrames(const std::string& path, const FrameSourceOptions& options);

}  // namespace evit::formats
