#include "tools/formats/frames/zip_tree.h"

#include <zip.h>

#include <fstream>
#include <stdexcept>

namespace evit::formats {
namespace {

constexpr std::uint64_t kMaxFile = 1U << 28;  // bytes; a forged length must not decide what is reserved

}  // namespace

bool ZipTree::Recognises(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  char head[4] = {};
  file.read(head, sizeof head);
  return file && head[0] == 'P' && head[1] == 'K' && (head[2] == 3 || head[2] == 5);
}

void ZipTree::Close::operator()(zip* archive) const { ::zip_discard(archive); }

ZipTree::ZipTree(const std::string& path) : path_(path) {
  int code = 0;
  archive_.reset(::zip_open(path.c_str(), ZIP_RDONLY, &code));
  if (!archive_) {
    zip_error_t error;
    ::zip_error_init_with_code(&error, code);
    const std::string why = ::zip_error_strerror(&error);
    ::zip_error_fini(&error);
    throw std::runtime_error(path + ": this zip archive cannot be read (" + why +
                             "); was its download complete?");
  }
  const auto n = ::zip_get_num_entries(archive_.get(), 0);
  for (zip_int64_t k = 0; k < n; ++k) {
    const char* entry = ::zip_get_name(archive_.get(), static_cast<zip_uint64_t>(k), 0);
    const std::string name = entry == nullptr ? "" : entry;
    const std::string file = name.substr(name.rfind('/') + 1);
    if (file.empty() || file[0] == '.' || name.rfind("__MACOSX/", 0) == 0) continue;
    if (index_.emplace(name, static_cast<std::uint64_t>(k)).second) names_.push_back(name);
  }
}

std::vector<std::uint8_t> ZipTree::Read(const std::string& name) {
  const auto at = index_.find(name);
  if (at == index_.end()) throw std::runtime_error(PathOf(name) + ": is not in the archive");
  zip_stat_t about;
  ::zip_stat_init(&about);
  if (::zip_stat_index(archive_.get(), at->second, 0, &about) != 0 || (about.valid & ZIP_STAT_SIZE) == 0)
    throw std::runtime_error(PathOf(name) + ": the archive is damaged here");
  if (about.size > kMaxFile) throw std::runtime_error(PathOf(name) + ": is too large for a picture");
  struct CloseFile {
    void operator()(zip_file* file) const { ::zip_fclose(file); }
  };
  const std::unique_ptr<zip_file, CloseFile> file(::zip_fopen_index(archive_.get(), at->second, 0));
  std::vector<std::uint8_t> bytes(about.size);
  if (!file || ::zip_fread(file.get(), bytes.data(), about.size) != static_cast<zip_int64_t>(about.size)) {
    throw std::runtime_error(PathOf(name) + ": cannot be unpacked (" +
                             (file ? "damaged or cut off" : ::zip_strerror(archive_.get())) + ")");
  }
  return bytes;
}

}  // namespace evit::formats
