#pragma once

#include <cstdint>
#include <string>
#include <variant>

namespace google::protobuf {
class FieldDescriptor;
}

namespace evit {

/// A value of a settings file. Enums are their number; a group that was only opened has none.
using SettingValue = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

/// One value that a file sets, and where.
struct Setting {
  std::string path;  // "evit.window.size"
  SettingValue value;
  const google::protobuf::FieldDescriptor* field = nullptr;
  std::string file;
  int line = 0;  // from 1

  std::string Place() const { return file + ":" + std::to_string(line); }
};

}  // namespace evit
