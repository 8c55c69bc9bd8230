#pragma once

#include <string>

namespace google::protobuf {
class Message;
}

namespace evit {

/// Reads a text protobuf file. Throws ConfigError: not readable, unknown key or bad value (file, line,
/// column), required keys that are missing, all at once. `schema`: where keys and units are described, for
/// the remedy.
void ParseTextFile(const std::string& path, const std::string& schema, google::protobuf::Message* message);

}  // namespace evit
