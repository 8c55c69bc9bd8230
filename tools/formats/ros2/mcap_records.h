#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/formats/import/byte_file.h"

namespace evit::formats {

/// One record of an MCAP file: what it is, and its contents.
struct McapRecord {
  enum Type : std::uint8_t {
    kFooter = 0x02,
    kSchema = 0x03,
    kChannel = 0x04,
    kMessage = 0x05,
    kChunk = 0x06,
    kDataEnd = 0x0F
  };

  std::uint8_t type = 0;
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// Reads the numbers and texts in a record; all throw std::runtime_error where it ends before.
class McapFields {
 public:
  McapFields(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  explicit McapFields(const McapRecord& record) : McapFields(record.data, record.size) {}

  std::uint64_t Number(std::size_t bytes);
  std::string Text();
  const std::uint8_t* Take(std::uint64_t n);
  std::size_t left() const { return size_ - at_; }

 private:
  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
};

/// The records of an MCAP file from the front to its data's end, those in chunks too.
class McapRecords {
 public:
  explicit McapRecords(const std::string& path);
  /// False at the end, also of a file that is cut off. Throws std::runtime_error naming the file where it is
  /// damaged.
  bool Next(McapRecord* record);
  const ByteFile& file() const { return file_; }
  bool cut_off() const { return cut_off_; }

 private:
  bool NextInChunk(McapRecord* record);
  bool End(bool cut_off) {
    cut_off_ = cut_off;
    return false;
  }
  void OpenChunk(const McapRecord& chunk);

  ByteFile file_;
  std::vector<std::uint8_t> chunk_;
  std::size_t at_ = 0;  // in the chunk
  bool cut_off_ = false;
};

}  // namespace evit::formats
