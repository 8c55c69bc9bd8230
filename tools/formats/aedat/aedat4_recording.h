#pragma once

#include <map>
#include <memory>
#include <string>

#include "tools/formats/aedat/stream_list.h"
#include "tools/formats/import/byte_file.h"
#include "tools/formats/import/recording.h"

namespace evit::formats {

/// The packets of an AEDAT 4 file (docs.inivation.com, AEDAT 4.0): a text line, a header (FlatBuffers), then
/// packets, each compressed by itself.
class Aedat4Packets {
 public:
  /// Throws std::runtime_error naming the file where the header cannot be read.
  explicit Aedat4Packets(const std::string& path);

  /// Goes to the next packet of stream `id`; false at the end. A file that was not closed properly ends with
  /// its last whole packet.
  bool Next(int id);
  const std::vector<std::uint8_t>& contents() const { return contents_; }  // uncompressed
  const std::map<int, AedatStream>& streams() const { return streams_; }
  const char* compression() const;
  const ByteFile& file() const { return file_; }
  bool cut_off() const { return cut_off_; }

 private:
  void Decompress(const std::uint8_t* data, std::size_t size);

  ByteFile file_;
  std::map<int, AedatStream> streams_;
  int compression_ = 0;
  bool cut_off_ = false;
  std::uint64_t end_ = 0;  // of the packets
  std::vector<std::uint8_t> contents_;
};

/// An AEDAT 4 file of DV. Of several cameras it takes the first; frames and triggers are passed over.
class Aedat4Recording : public Recording {
 public:
  static bool Recognises(const std::string& path);

  explicit Aedat4Recording(const std::string& path);
  RecordingInfo info() const override { return info_; }
  std::unique_ptr<EventSource> Events(int width, int height) override;
  ImportStreams Streams() override;

 private:
  std::string path_;
  RecordingInfo info_;
  int events_ = -1, imu_ = -1;  // streams; -1: none
};

}  // namespace evit::formats
