#pragma once

#include <zip.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace evit {

/// Writes a zip archive of files (name in the archive, contents), for tests.
inline void WriteZip(const std::string& path, const std::vector<std::pair<std::string, std::string>>& files) {
  int code = 0;
  zip_t* archive = ::zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  if (archive == nullptr) throw std::runtime_error(path);
  for (const auto& [name, contents] : files) {
    zip_source_t* source = ::zip_source_buffer(archive, contents.data(), contents.size(), 0);
    ::zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8);
  }
  if (::zip_close(archive) != 0) throw std::runtime_error(path);
}

}  // namespace evit
