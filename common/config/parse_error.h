#pragma once

#include <string>

namespace google::protobuf {
class Descriptor;
}

namespace evit {

/// Where and why protobuf's parser gave up; line and column from 0.
struct ParseFault {
  int line = 0;
  int column = 0;
  std::string words;
};

/// The same for people: "LINE:COLUMN: KEY: what is wrong; the remedy". Knows which values a key may have, and
/// keys that are nearly right.
std::string Explain(const google::protobuf::Descriptor* root, const std::string& text,
                    const ParseFault& fault);

}  // namespace evit
