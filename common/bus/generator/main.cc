// message_generator HEADER SOURCE FILE.lcm ...: writes what common/bus/codec needs to know of a package's
// messages.
#include <cstdio>
#include <exception>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "common/bus/generator/message_code.h"

namespace {

void Write(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written");
}

std::string Read(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) throw std::runtime_error(path + ": cannot be read");
  return text.str();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: %s HEADER SOURCE FILE.lcm ...\n", argv[0]);
    return 2;
  }
  try {
    std::vector<evit::generator::MessageType> types;
    for (int i = 3; i < argc; ++i) types.push_back(evit::generator::ParseLcm(Read(argv[i]), argv[i]));
    Write(argv[1], evit::generator::MessagesHeader(types));
    Write(argv[2], evit::generator::LayoutsSource(types));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
