#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tools/formats/import/byte_file.h"

namespace evit::formats {

/// A record of a bag of ROS 1: fields of its header by name, and its data.
struct BagRecord {
  std::map<std::string, std::string, std::less<>> fields;
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;

  /// The number in a field of as many bytes; 0 where there is none of that length.
  std::uint64_t Number(std::string_view field) const;
  std::string Text(std::string_view field) const;
  int Op() const { return static_cast<int>(Number("op")); }

  static constexpr int kMessage = 2, kBagHeader = 3, kChunk = 5, kConnection = 7;
};

/// Takes the fields of a header, or of a connection's data, which are laid out like one; false where they are
/// not whole.
bool ParseFields(const std::uint8_t* data, std::size_t size, BagRecord* record);

/// Takes the record at `*at` of a piece of memory and moves on; false where it is not whole.
bool NextRecord(const std::uint8_t* data, std::size_t size, std::size_t* at, BagRecord* record);

/// The chunks of a bag, from its beginning up to where it ends or is cut off, without its index.
class BagChunks {
 public:
  /// Throws std::runtime_error naming the file where it is no bag of format 2.0.
  explicit BagChunks(const std::string& path);

  /// The contents of the next chunk, uncompressed, valid until the next call. False at the end. Of a
  /// recording that was not ended the chunk that was being written is the last: its whole records, none where
  /// it is compressed. Throws std::runtime_error naming file and position where it is damaged.
  bool Next(std::vector<std::uint8_t>* contents);
  /// Where the index should begin; 0: recording was not ended.
  std::uint64_t index_position() const { return index_position_; }
  /// At the end: whether the file ends within a record, or within the chunk that was being written.
  bool cut_off() const { return cut_off_; }
  const ByteFile& file() const { return file_; }

 private:
  bool Take(BagRecord* record);
  bool TakeOpen(bool packed, std::vector<std::uint8_t>* contents);

  ByteFile file_;
  std::uint64_t index_position_ = 0;
  bool cut_off_ = false;
};

}  // namespace evit::formats
