#include "tools/formats/numpy/npy_input.h"

#include <zip.h>

#include <algorithm>
#include <stdexcept>

#include "common/text/words.h"
#include "tools/formats/import/byte_file.h"

namespace evit::formats {
namespace {

constexpr char kSuffix[] = ".npy";
constexpr std::int64_t kMaxArrays = 10'000;

class FileInput : public NpyInput {
 public:
  explicit FileInput(const std::string& path) : file_(path) {}
  const std::uint8_t* Take(std::uint64_t n) override { return file_.Take(n, "the array"); }
  void Skip(std::uint64_t n) override {
    if (n > left()) file_.Fail("is cut off");
    file_.Seek(file_.position() + n);
  }
  std::uint64_t left() const override { return file_.size() - file_.position(); }
  [[noreturn]] void Fail(const std::string& what) const override { file_.Fail(what); }

 private:
  ByteFile file_;
};

using Archive = std::unique_ptr<zip_t, decltype(&zip_discard)>;

Archive OpenZip(const std::string& path) {
  int error = 0;
  Archive archive(zip_open(path.c_str(), ZIP_RDONLY, &error), zip_discard);
  if (archive == nullptr)
    throw std::runtime_error(path +
                             ": is not a complete archive (cut off or damaged); copy or download it again");
  return archive;
}

class ZipInput : public NpyInput {
 public:
  ZipInput(std::string path, std::string name)
      : path_(std::move(path)),
        name_(std::move(name)),
        archive_(OpenZip(path_)),
        entry_(nullptr, zip_fclose) {
    zip_stat_t stat;
    const std::string file = name_ + kSuffix;
    if (zip_stat(archive_.get(), file.c_str(), 0, &stat) != 0 || (stat.valid & ZIP_STAT_SIZE) == 0)
      Fail("there is no such array");
    if ((stat.valid & ZIP_STAT_ENCRYPTION_METHOD) != 0 && stat.encryption_method != ZIP_EM_NONE)
      Fail("is encrypted; save it without");
    left_ = stat.size;
    entry_.reset(zip_fopen(archive_.get(), file.c_str(), 0));
    if (entry_ == nullptr) Fail(std::string("cannot be unpacked: ") + zip_strerror(archive_.get()));
  }
  const std::uint8_t* Take(std::uint64_t n) override {
    if (n > left_) Fail("is cut off");
    buffer_.resize(static_cast<std::size_t>(n));
    std::uint64_t at = 0;
    while (at < n) {
      const zip_int64_t read = zip_fread(entry_.get(), buffer_.data() + at, n - at);
      if (read <= 0) Fail("is damaged; copy or download the file again");
      at += static_cast<std::uint64_t>(read);
    }
    left_ -= n;
    return buffer_.data();
  }
  void Skip(std::uint64_t n) override {
    constexpr std::uint64_t kPiece = 1 << 20;
    for (std::uint64_t skipped = 0; skipped < n; skipped += std::min(kPiece, n - skipped))
      Take(std::min(kPiece, n - skipped));
  }
  std::uint64_t left() const override { return left_; }
  [[noreturn]] void Fail(const std::string& what) const override {
    throw std::runtime_error(path_ + ": array " + name_ + ": " + what);
  }

 private:
  std::string path_, name_;
  Archive archive_;
  std::unique_ptr<zip_file_t, decltype(&zip_fclose)> entry_;
  std::vector<std::uint8_t> buffer_;
  std::uint64_t left_ = 0;
};

}  // namespace

std::unique_ptr<NpyInput> OpenNpy(const std::string& path) { return std::make_unique<FileInput>(path); }

bool IsNpz(const std::string& path) {
  ByteFile file(path);
  constexpr std::size_t kHead = 100;  // the first name is at byte 30
  file.Fill(kHead);
  const std::string begin(reinterpret_cast<const char*>(file.data()), std::min(kHead, file.available()));
  return begin.rfind("PK\x03\x04", 0) == 0 && begin.find(kSuffix) != std::string::npos;
}

std::vector<std::string> NamesInNpz(const std::string& path) {
  const Archive archive = OpenZip(path);
  std::vector<std::string> names;
  const zip_int64_t n = zip_get_num_entries(archive.get(), 0);
  if (n > kMaxArrays)
    throw std::runtime_error(path + ": holds " + std::to_string(n) + " files: too many for arrays of events");
  for (zip_int64_t k = 0; k < n; ++k) {
    const char* name = zip_get_name(archive.get(), static_cast<zip_uint64_t>(k), 0);
    if (name != nullptr && EndsWith(name, kSuffix))
      names.emplace_back(name, std::char_traits<char>::length(name) - 4);
  }
  return names;
}

std::unique_ptr<NpyInput> OpenInNpz(const std::string& path, const std::string& name) {
  return std::make_unique<ZipInput>(path, name);
}

}  // namespace evit::formats
