#include "tools/formats/prophesee/raw_header.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "common/text/words.h"

namespace evit::formats {
namespace {

constexpr std::size_t kMaxHeader = 1 << 16;  // bytes

bool Plausible(int width, int height) {
  return width >= 16 && height >= 16 && width <= 8192 && height <= 8192;
}

std::string Trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

}  // namespace

RawHeader::RawHeader(ByteFile* file) {
  while (true) {
    while (file->available() < kMaxHeader && file->Fill(kMaxHeader)) {
    }
    const char* begin = reinterpret_cast<const char*>(file->data());
    if (file->available() < 2 || begin[0] != '%' || begin[1] != ' ') return;
    const auto* newline =
        static_cast<const char*>(std::memchr(begin, '\n', std::min(file->available(), kMaxHeader)));
    if (newline == nullptr) file->Fail("a header line does not end: is it a RAW or DAT file?");
    std::istringstream line(std::string(begin + 2, newline));
    file->Use(static_cast<std::size_t>(newline - begin) + 1);
    std::string key, value;
    line >> key;
    std::getline(line >> std::ws, value);
    while (!value.empty() && std::isspace(static_cast<unsigned char>(value.back())) != 0) value.pop_back();
    if (LowerCase(key) == "end") return;
    values.emplace(LowerCase(key), value);
    if (values.size() > 1000) file->Fail("has more than 1000 header lines: is it a RAW or DAT file?");
    if (LowerCase(key) != "format") continue;
    std::istringstream parts(value);
    std::string part;
    std::getline(parts, part, ';');
    values["format"] = Trimmed(part);
    while (std::getline(parts, part, ';')) {
      const std::size_t equal = part.find('=');
      if (equal != std::string::npos)
        values["format." + LowerCase(Trimmed(part.substr(0, equal)))] = Trimmed(part.substr(equal + 1));
    }
  }
}

std::string RawHeader::Get(const std::string& key) const {
  for (const std::string& name : {"format." + key, key}) {
    const auto found = values.find(name);
    if (found != values.end()) return found->second;
  }
  return "";
}

void SensorSize(const RawHeader& header, int* width, int* height) {
  const auto number = [&](const char* key) { return std::atoi(header.Get(key).c_str()); };
  *width = number("width");
  *height = number("height");
  if (Plausible(*width, *height)) return;
  if (std::sscanf(header.Get("geometry").c_str(), "%dx%d", width, height) == 2 && Plausible(*width, *height))
    return;
  // Files of earlier versions name only the plug-in that wrote them, or the sensor.
  const std::string names =
      LowerCase(header.Get("plugin_name") + " " + header.Get("camera_integrator_name") + " " +
                header.Get("sensor_name") + " " + header.Get("sensor_generation"));
  *width = *height = 0;
  const struct {
    const char* name;
    int width, height;
  } known[] = {{"genx320", 320, 320}, {"imx636", 1280, 720}, {"gen41", 1280, 720}, {"gen4", 1280, 720},
               {"4.", 1280, 720},     {"gen31", 640, 480},   {"gen3", 640, 480},   {"3.", 640, 480}};
  for (const auto& k : known) {
    if (names.find(k.name) == std::string::npos) continue;
    *width = k.width;
    *height = k.height;
    return;
  }
}

}  // namespace evit::formats
