#include "tools/formats/bag/bag_chunks.h"

#include <rosbag/chunked_file.h>

#include <algorithm>
#include <cstring>
#include <exception>

#include "tools/formats/ros/message_store.h"

namespace evit::formats {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::uint32_t kMostHeader = 1 << 20;  // bytes: a connection's names its type and topic

std::uint32_t Length(const std::uint8_t* at) {
  std::uint32_t n;
  std::memcpy(&n, at, sizeof n);
  return n;
}

}  // namespace

std::uint64_t BagRecord::Number(std::string_view field) const {
  const auto found = fields.find(field);
  std::uint64_t value = 0;
  if (found == fields.end() || found->second.size() > sizeof value) return 0;
  std::memcpy(&value, found->second.data(), found->second.size());
  return value;
}

std::string BagRecord::Text(std::string_view field) const {
  const auto found = fields.find(field);
  return found == fields.end() ? "" : found->second;
}

// `length`, then "name=value", again and again.
bool ParseFields(const std::uint8_t* data, std::size_t size, BagRecord* record) {
  record->fields.clear();
  for (std::size_t at = 0; at < size;) {
    if (size - at < 4) return false;
    const std::uint32_t n = Length(data + at);
    at += 4;
    if (n > size - at) return false;
    const std::string_view field(reinterpret_cast<const char*>(data + at), n);
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) return false;
    record->fields.emplace(field.substr(0, equals), field.substr(equals + 1));
    at += n;
  }
  return true;
}

bool NextRecord(const std::uint8_t* data, std::size_t size, std::size_t* at, BagRecord* record) {
  std::size_t here = *at;
  if (size - here < 4) return false;
  const std::uint32_t header = Length(data + here);
  here += 4;
  if (size - here < 4 || header > size - here - 4 || !ParseFields(data + here, header, record)) return false;
  here += header;
  record->size = Length(data + here);
  here += 4;
  if (record->size > size - here) return false;
  record->data = data + here;
  *at = here + record->size;
  return true;
}

BagChunks::BagChunks(const std::string& path) : file_(path) {
  if (!file_.Fill(kMagic.size()) || file_.available() < kMagic.size() ||
      std::memcmp(file_.data(), kMagic.data(), kMagic.size()) != 0)
    file_.Fail("is no ROS 1 bag of format 2.0");
  file_.Use(kMagic.size());
  BagRecord header;
  if (Take(&header) && header.Op() == BagRecord::kBagHeader) index_position_ = header.Number("index_pos");
}

// False at the end of the file and of what is whole of it.
bool BagChunks::Take(BagRecord* record) {
  const std::uint64_t begin = file_.position();
  const auto whole = [&](std::size_t n) {
    while (file_.available() < n && file_.Fill(n - file_.available())) {
    }
    cut_off_ = file_.available() < n;
    return !cut_off_;
  };
  if (file_.available() == 0 && !file_.Fill(1)) return false;  // the end
  if (!whole(4)) return false;
  const std::uint32_t header = Length(file_.data());
  if (header > kMostHeader) file_.Fail("is damaged at byte " + std::to_string(begin));
  if (!whole(8 + std::size_t{header})) return false;
  const std::size_t data = Length(file_.data() + 4 + header);
  if (data > kMaxMessage)
    file_.Fail("is damaged at byte " + std::to_string(begin) + ": a record of " + std::to_string(data) +
               " bytes");
  if (!whole(8 + header + data)) return false;
  std::size_t at = 0;
  if (!NextRecord(file_.data(), 8 + header + data, &at, record))
    file_.Fail("is damaged at byte " + std::to_string(begin));
  file_.Use(at);
  return true;
}

// The chunk that was being written, whose sizes would have been filled in at its end: all that follows.
bool BagChunks::TakeOpen(bool packed, std::vector<std::uint8_t>* contents) {
  cut_off_ = true;
  contents->clear();
  if (!packed) {
    const auto left =
        static_cast<std::size_t>(std::min<std::uint64_t>(file_.size() - file_.position(), kMaxMessage));
    while (file_.available() < left && file_.Fill(left - file_.available())) {
    }
    BagRecord record;
    std::size_t whole = 0;
    while (NextRecord(file_.data(), file_.available(), &whole, &record)) {
    }
    contents->assign(file_.data(), file_.data() + whole);
  }  // else its end is missing, without which it cannot be unpacked
  file_.Seek(file_.size());
  return !contents->empty();
}

bool BagChunks::Next(std::vector<std::uint8_t>* contents) {
  BagRecord record;
  do {
    if (!Take(&record)) return false;
  } while (record.Op() != BagRecord::kChunk);
  const std::string packed = record.Text("compression");
  if (record.size == 0 && index_position_ == 0) return TakeOpen(packed != "none", contents);
  const std::uint64_t size = record.Number("size");
  if (size > kMaxMessage) file_.Fail("is damaged: a chunk of " + std::to_string(size) + " bytes");
  contents->resize(size);
  const auto type = packed == "bz2"   ? rosbag::compression::BZ2
                    : packed == "lz4" ? rosbag::compression::LZ4
                                      : rosbag::compression::Uncompressed;
  if (type == rosbag::compression::Uncompressed) {
    if (packed != "none" || record.size != size)
      file_.Fail("holds a chunk with compression '" + packed + "', which is not read, or of a wrong size");
    std::copy(record.data, record.data + record.size, contents->begin());
    return true;
  }
  std::vector<std::uint8_t> source(record.data, record.data + record.size);
  try {
    rosbag::ChunkedFile decoder;
    decoder.decompress(type, contents->data(), static_cast<unsigned>(size), source.data(),
                       static_cast<unsigned>(source.size()));
  } catch (const std::exception& error) {
    file_.Fail("a chunk before byte " + std::to_string(file_.position()) + " cannot be unpacked (" +
               error.what() + "); copy the file again");
  }
  return true;
}

}  // namespace evit::formats
