#include "tools/formats/ros2/mcap_records.h"

#include <cstring>
#include <stdexcept>

#include "tools/formats/compression/decompress.h"
#include "tools/formats/ros/message_store.h"

namespace evit::formats {
namespace {

constexpr std::size_t kMagic = 8, kRecordHeader = 9;  // bytes

std::uint64_t LittleEndian(const std::uint8_t* data, std::size_t bytes) {
  std::uint64_t value = 0;
  std::memcpy(&value, data, bytes);
  return value;
}

}  // namespace

std::uint64_t McapFields::Number(std::size_t bytes) { return LittleEndian(Take(bytes), bytes); }

std::string McapFields::Text() {
  const std::uint64_t n = Number(4);
  const auto* text = reinterpret_cast<const char*>(Take(n));
  return {text, static_cast<std::size_t>(n)};
}

const std::uint8_t* McapFields::Take(std::uint64_t n) {
  if (n > left())
    throw std::runtime_error("a record ends before its fields do: the file is damaged; copy it again");
  at_ += static_cast<std::size_t>(n);
  return data_ + at_ - n;
}

McapRecords::McapRecords(const std::string& path) : file_(path) { file_.Skip(kMagic, "magic"); }

bool McapRecords::NextInChunk(McapRecord* record) {
  if (at_ == chunk_.size()) return false;
  McapFields fields(chunk_.data() + at_, chunk_.size() - at_);
  record->type = static_cast<std::uint8_t>(fields.Number(1));
  const std::uint64_t size = fields.Number(8);
  record->data = fields.Take(size);
  record->size = static_cast<std::size_t>(size);
  at_ = chunk_.size() - fields.left();
  return true;
}

void McapRecords::OpenChunk(const McapRecord& chunk) {
  McapFields fields(chunk);
  fields.Take(8 + 8);  // first and last time
  const std::uint64_t size = fields.Number(8);
  fields.Take(4);  // checksum
  const std::string compression = fields.Text();
  const std::uint64_t packed = fields.Number(8);
  const std::uint8_t* data = fields.Take(packed);
  if (size > kMaxMessage) throw std::runtime_error("a chunk says it has " + std::to_string(size) + " bytes");
  if (compression.empty()) {
    chunk_.assign(data, data + packed);
  } else if (compression == "lz4") {
    DecompressLz4(data, static_cast<std::size_t>(packed), kMaxMessage, &chunk_);
  } else if (compression == "zstd") {
    DecompressZstd(data, static_cast<std::size_t>(packed), kMaxMessage, &chunk_);
  } else {
    throw std::runtime_error("a chunk's compression is \"" + compression +
                             "\"; known are none, lz4 and zstd");
  }
  at_ = 0;
}

bool McapRecords::Next(McapRecord* record) {
  while (true) {
    const std::uint64_t at = file_.position();
    try {
      if (NextInChunk(record)) return true;
      if (file_.size() - at < kRecordHeader) return End(true);
      const std::uint8_t* header = file_.Take(kRecordHeader, "record");
      record->type = header[0];
      const std::uint64_t size = LittleEndian(header + 1, 8);
      if (record->type == McapRecord::kDataEnd || record->type == McapRecord::kFooter) return End(false);
      if (size > file_.size() - file_.position()) return End(true);
      if (record->type < McapRecord::kSchema || record->type > McapRecord::kChunk) {
        file_.Skip(size, "record");
        continue;
      }
      if (size > kMaxMessage)
        throw std::runtime_error("a record says it has " + std::to_string(size) + " bytes");
      record->data = file_.Take(size, "record");
      record->size = static_cast<std::size_t>(size);
      if (record->type != McapRecord::kChunk) return true;
      OpenChunk(*record);
    } catch (const std::runtime_error& error) {
      file_.Fail("at byte " + std::to_string(at) + ": " + error.what());
    }
  }
}

}  // namespace evit::formats
