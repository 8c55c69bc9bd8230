#include "tools/formats/aedat/aedat4_packets.h"

#include <cstring>
#include <stdexcept>

#include "common/files/load_number.h"
#include "tools/formats/aedat/flat_table.h"
#include "tools/formats/compression/decompress.h"

namespace evit::formats {
namespace {

constexpr char kVersion[] = "#!AER-DAT4.0\r\n";
constexpr std::uint32_t kMaxHeader = 1 << 24, kMaxPacket = 1 << 28;  // bytes

}  // namespace

bool Aedat4Packets::Recognises(const std::string& path) {
  ByteFile file(path);
  constexpr std::size_t n = sizeof kVersion - 1;
  return file.Fill(n) && file.available() >= n && std::memcmp(file.data(), kVersion, n) == 0;
}

Aedat4Packets::Aedat4Packets(const std::string& path) : file_(path), end_(file_.size()) {
  file_.Skip(sizeof kVersion - 1, "version");
  const auto size = LoadNumber<std::uint32_t>(file_.Take(4, "header"));
  if (size > kMaxHeader)
    file_.Fail("its header says it has " + std::to_string(size) + " bytes: it is damaged");
  std::vector<std::uint8_t> header(4 + size);
  std::memcpy(header.data() + 4, file_.Take(size, "header"), size);
  try {
    const FlatTable table = FlatTable::Root(header.data(), header.size(), "IOHE");
    compression_ = table.Get<std::int32_t>(0, 0);
    const auto list = table.Get<std::int64_t>(1, -1);
    if (list > 0 && static_cast<std::uint64_t>(list) <= file_.size()) end_ = static_cast<std::uint64_t>(list);
    streams_ = ParseStreamList(table.String(2));
  } catch (const std::runtime_error& error) {
    file_.Fail(error.what());
  }
  if (compression_ < 0 || compression_ > 4)
    file_.Fail("its compression, number " + std::to_string(compression_) + ", is not known");
}

const char* Aedat4Packets::compression() const {
  constexpr const char* kNames[] = {"not compressed", "LZ4", "LZ4", "Zstandard", "Zstandard"};
  return kNames[compression_];
}

bool Aedat4Packets::Next(int id) {
  while (file_.position() + 8 <= end_) {
    const std::uint8_t* header = file_.Take(8, "packet");
    const auto stream = LoadNumber<std::int32_t>(header);
    const auto size = LoadNumber<std::uint32_t>(header + 4);
    if (size > end_ - file_.position()) {
      cut_off_ = true;
      return false;
    }
    if (stream != id) {
      file_.Skip(size, "packet");
      continue;
    }
    if (size > kMaxPacket)
      file_.Fail("a packet says it has " + std::to_string(size) + " bytes: the file is damaged");
    const std::uint64_t at = file_.position();
    try {
      Decompress(file_.Take(size, "packet"), size);
    } catch (const std::runtime_error& error) {
      file_.Fail("packet at byte " + std::to_string(at) + ": " + error.what() + "; copy the file again");
    }
    return true;
  }
  return false;
}

void Aedat4Packets::Decompress(const std::uint8_t* data, std::size_t size) {
  if (compression_ == 0) {
    contents_.assign(data, data + size);
  } else if (compression_ <= 2) {
    DecompressLz4(data, size, kMaxPacket, &contents_);
  } else {
    DecompressZstd(data, size, kMaxPacket, &contents_);
  }
}

}  // namespace evit::formats
