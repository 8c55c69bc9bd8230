#include "tools/formats/import/byte_file.h"

#include <sys/stat.h>

#include <algorithm>
#include <stdexcept>

namespace evit::formats {

ByteFile::ByteFile(const std::string& path) : path_(path) {
  file_.reset(std::fopen(path.c_str(), "rb"));
  if (!file_) Fail("cannot be read; is the path right?");
  struct stat info {};
  if (fstat(fileno(file_.get()), &info) != 0 || !S_ISREG(info.st_mode)) Fail("is not a file");
  size_ = static_cast<std::uint64_t>(info.st_size);
}

bool ByteFile::Fill(std::size_t size) {
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(used_));
  used_ = 0;
  const std::size_t old = buffer_.size();
  buffer_.resize(old +
                 static_cast<std::size_t>(std::min<std::uint64_t>(size, size_ - std::min(size_, n_read_))));
  const std::size_t n = std::fread(buffer_.data() + old, 1, buffer_.size() - old, file_.get());
  if (std::ferror(file_.get()) != 0) Fail("reading failed; check the disk or the network");
  buffer_.resize(old + n);
  n_read_ += n;
  return n > 0;
}

const std::uint8_t* ByteFile::Take(std::uint64_t n, const char* field) {
  if (n > size_ - std::min(size_, position()))
    Fail(std::string(field) + " needs " + std::to_string(n) + " bytes at " + std::to_string(position()) +
         ", the file has " + std::to_string(size_ - position()) +
         " left: it is cut off or damaged; copy it again");
  const auto need = static_cast<std::size_t>(n);
  while (available() < need) {
    if (!Fill(std::max<std::size_t>(need - available(), 1 << 16)))
      Fail(std::string(field) + ": the file has become shorter");
  }
  used_ += need;
  return buffer_.data() + used_ - need;
}

void ByteFile::Skip(std::uint64_t n, const char* field) {
  if (n > size_ - std::min(size_, position()))
    Fail(std::string(field) + " goes beyond the end of the file: it is cut off or damaged; copy it again");
  if (n <= available()) {
    used_ += static_cast<std::size_t>(n);
  } else {
    Seek(position() + n);
  }
}

void ByteFile::Seek(std::uint64_t position) {
  buffer_.clear();
  used_ = 0;
  n_read_ = std::min(position, size_);
  if (fseeko(file_.get(), static_cast<off_t>(n_read_), SEEK_SET) != 0)
    Fail("cannot be read at " + std::to_string(position));
}

double ByteFile::share() const {
  return size_ > 0 ? static_cast<double>(position()) / static_cast<double>(size_) : 1;
}

void ByteFile::Fail(const std::string& what) const { throw std::runtime_error(path_ + ": " + what); }

}  // namespace evit::formats
