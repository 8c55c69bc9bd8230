#include "tools/formats/aedat/stream_list.h"

#include <cstdlib>
#include <stdexcept>
#include <vector>

namespace evit::formats {
namespace {

// The value of an attribute of a tag: name="...".
std::string Attribute(std::string_view tag, const std::string& name) {
  const std::string key = " " + name + "=\"";
  const std::size_t begin = tag.find(key);
  if (begin == std::string_view::npos) return "";
  const std::size_t end = tag.find('"', begin + key.size());
  if (end == std::string_view::npos) return "";
  return std::string(tag.substr(begin + key.size(), end - begin - key.size()));
}

void Store(const std::vector<std::string>& path, const std::string& key, std::string value,
           std::map<int, AedatStream>* streams) {
  // .../outInfo/ID[/info]
  std::size_t k = 0;
  while (k < path.size() && path[k] != "outInfo") ++k;
  if (k + 1 >= path.size()) return;
  AedatStream& stream = (*streams)[std::atoi(path[k + 1].c_str())];
  if (key == "typeIdentifier") stream.type = std::move(value);
  if (key == "originalOutputName") stream.name = std::move(value);
  if (key == "source") stream.source = std::move(value);
  if (key == "sizeX") stream.width = std::atoi(value.c_str());
  if (key == "sizeY") stream.height = std::atoi(value.c_str());
}

}  // namespace

std::map<int, AedatStream> ParseStreamList(std::string_view xml) {
  std::map<int, AedatStream> streams;
  std::vector<std::string> path;
  for (std::size_t at = xml.find('<'); at != std::string_view::npos; at = xml.find('<', at)) {
    const std::size_t end = xml.find('>', at);
    if (end == std::string_view::npos) throw std::runtime_error("the header's list of streams is cut off");
    const std::string_view tag = xml.substr(at, end - at);
    at = end + 1;
    if (tag.substr(0, 6) == "<node ") {
      if (tag.back() != '/') path.push_back(Attribute(tag, "name"));
      if (path.size() > 32) throw std::runtime_error("the header's list of streams is nested too deeply");
    } else if (tag == "</node") {
      if (path.empty()) throw std::runtime_error("the header's list of streams is damaged");
      path.pop_back();
    } else if (tag.substr(0, 6) == "<attr ") {
      const std::size_t close = xml.find('<', at);
      if (close != std::string_view::npos)
        Store(path, Attribute(tag, "key"), std::string(xml.substr(at, close - at)), &streams);
    }
  }
  return streams;
}

}  // namespace evit::formats
