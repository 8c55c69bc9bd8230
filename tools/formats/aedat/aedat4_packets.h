#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tools/formats/aedat/stream_list.h"
#include "tools/formats/import/byte_file.h"

namespace evit::formats {

/// The packets of an AEDAT 4 file (docs.inivation.com, AEDAT 4.0): a text line, a header (FlatBuffers), then
/// packets, each compressed by itself.
class Aedat4Packets {
 public:
  /// By the first bytes.
  static bool Recognises(const std::string& path);

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

}  // namespace evit::formats
