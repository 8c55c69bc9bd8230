#include "common/bus/generator/lcm_file.h"

#include <regex>
#include <sstream>
#include <stdexcept>

namespace evit::generator {
namespace {

std::vector<Dimension> ParseDimensions(const std::string& text) {
  static const std::regex pattern(R"(\[(\w+)\])");
  std::vector<Dimension> dimensions;
  for (std::sregex_iterator i(text.begin(), text.end(), pattern), end; i != end; ++i) {
    const std::string inside = (*i)[1];
    const bool number = inside.find_first_not_of("0123456789") == std::string::npos;
    dimensions.push_back(number ? Dimension{std::stoll(inside), ""} : Dimension{0, inside});
  }
  return dimensions;
}

}  // namespace

MessageType ParseLcm(const std::string& text, const std::string& file) {
  static const std::regex package(R"(package (\w+);)"), open(R"(struct (\w+) \{)"), constants(R"(const .*;)"),
      field(R"((\w+) (\w+)((\[\w+\])*);)");
  MessageType type;
  type.file = file;
  bool closed = false;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const auto fail = [&](const std::string& what) {
      throw std::runtime_error(file + ":" + std::to_string(number) + ": " + what);
    };
    const std::size_t slashes = line.find("//");
    std::string code = line.substr(0, slashes);
    code.erase(0, code.find_first_not_of(' '));
    code.erase(code.find_last_not_of(" \r") + 1);
    std::smatch match;
    if (code.empty()) continue;
    if (closed) fail("one struct a file: nothing is expected after it");
    if (type.name.empty()) {
      if (std::regex_match(code, match, package) && type.package.empty()) {
        type.package = match[1];
      } else if (std::regex_match(code, match, open) && !type.package.empty()) {
        type.name = match[1];
      } else {
        fail("expected \"package NAME;\", then \"struct NAME {\": " + code);
      }
    } else if (code == "}") {
      closed = true;
    } else if (std::regex_match(code, match, field)) {
      const std::string comment = slashes == std::string::npos ? "" : line.substr(slashes + 2);
      type.fields.push_back({match[1], match[2], ParseDimensions(match[3]), comment, number});
    } else if (!std::regex_match(code, constants)) {
      fail("expected \"TYPE NAME;\" or \"TYPE NAME[DIMENSION];\": " + code);
    }
  }
  if (!closed) throw std::runtime_error(file + ": the struct has no end");
  return type;
}

}  // namespace evit::generator
