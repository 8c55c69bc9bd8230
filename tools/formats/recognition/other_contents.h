#pragma once

#include <string>

namespace evit::formats {

/// What a file that is not a recording is instead, with the remedy: "is compressed with gzip; gunzip it
/// first". Empty where it is not known either.
std::string OtherContents(const std::string& path);

}  // namespace evit::formats
