#pragma once

#include <map>
#include <string>
#include <string_view>

namespace evit::formats {

/// One stream of an AEDAT 4 file, as its header's XML lists them.
struct AedatStream {
  std::string type;    // EVTS, IMUS, FRME, TRIG
  std::string name;    // as the module that recorded it called it
  std::string source;  // camera
  int width = 0, height = 0;
};

/// Reads that list: `outInfo/ID/...` nodes and their attributes. Throws std::runtime_error where tags do not
/// close.
std::map<int, AedatStream> ParseStreamList(std::string_view xml);

}  // namespace evit::formats
