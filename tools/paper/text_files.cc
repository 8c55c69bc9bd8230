#include "tools/paper/text_files.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "common/files/whole_file.h"

namespace evit::paper {
namespace {

constexpr std::uint64_t kBasis = 14'695'981'039'346'656'037ULL, kPrime = 1'099'511'628'211ULL;

std::uint64_t Continue(std::uint64_t hash, const char* data, std::size_t size) {
  for (std::size_t k = 0; k < size; ++k) hash = (hash ^ static_cast<unsigned char>(data[k])) * kPrime;
  return hash;
}

}  // namespace

std::string ReadText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) throw std::runtime_error(path + ": cannot be read");
  return text;
}

void WriteText(const std::string& path, const std::string& text) {
  WholeFile file(path);
  file.stream() << text;
  file.Commit();
}

void MakeFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw std::runtime_error(path + ": is not a writable folder (" + error.message() + ")");
}

std::uint64_t HashOf(const std::string& text) { return Continue(kBasis, text.data(), text.size()); }

std::uint64_t HashOfFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  std::uint64_t hash = kBasis;
  std::vector<char> block(1 << 16);
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())) || file.gcount() > 0)
    hash = Continue(hash, block.data(), static_cast<std::size_t>(file.gcount()));
  return hash;
}

std::string HexText(std::uint64_t hash) {
  char text[20];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace evit::paper
