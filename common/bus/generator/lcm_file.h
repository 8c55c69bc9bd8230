#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace evit::generator {

/// One dimension of an array: a number, or the int32_t field before it that says how many.
struct Dimension {
  std::int64_t size = 0;
  std::string count;  // empty: `size` counts
};

struct Field {
  std::string type, name;
  std::vector<Dimension> dimensions;
  std::string comment;  // on the same line
  int line = 0;
};

/// The struct of one .lcm file.
struct MessageType {
  std::string file, package, name;
  std::vector<Field> fields;
};

/// Reads the part of LCM's language that lcmtypes/ uses: one package, one struct, one field or list of
/// constants a line. Throws std::runtime_error "FILE:LINE: ..." for anything else.
MessageType ParseLcm(const std::string& text, const std::string& file);

}  // namespace evit::generator
