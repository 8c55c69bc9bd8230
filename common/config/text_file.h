#pragma once

#include <string>
#include <vector>

#include "common/config/setting.h"

namespace google::protobuf {
class Message;
}

namespace evit {

/// Reads a text protobuf file; returns what it sets, in the schema's order, elements of repeated fields one
/// by one. Throws ConfigError: not readable, unknown key or bad value (file, line, column), a value outside
/// of what the schema's field options allow (file, line), required keys that are missing, all at once.
std::vector<Setting> ParseTextFile(const std::string& path, google::protobuf::Message* message);

/// The same without a look at what is missing.
std::vector<Setting> ParsePartialTextFile(const std::string& path, google::protobuf::Message* message);

}  // namespace evit
