#pragma once

#include <map>
#include <string>

#include "tools/formats/import/byte_file.h"

namespace evit::formats {

/// The text in front of Metavision's RAW and DAT files: lines `% KEY VALUE`, up to `% end` or the first that
/// is none.
struct RawHeader {
  /// Reads it from the beginning of a file; what follows is then at data(). Throws std::runtime_error where
  /// it does not end.
  explicit RawHeader(ByteFile* file);

  /// The value of a key, or of `format`'s parameter of that name (`% format EVT3;height=720;width=1280`);
  /// empty: none.
  std::string Get(const std::string& key) const;

  std::map<std::string, std::string> values;  // keys in lower case
};

/// A sensor's size by what the header says of it (size, geometry, plug-in, sensor's name); zeros where it
/// says nothing.
void SensorSize(const RawHeader& header, int* width, int* height);

}  // namespace evit::formats
