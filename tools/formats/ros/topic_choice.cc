#include "tools/formats/ros/topic_choice.h"

#include <algorithm>
#include <stdexcept>

namespace evit::formats {

std::string Ros1TypeName(const std::string& type) {
  const std::size_t at = type.find("/msg/");
  return at == std::string::npos ? type : type.substr(0, at) + type.substr(at + 4);
}

std::string TopicList(const MessageStore& store) {
  std::string list;
  for (const RosTopic& topic : store.topics())
    list.append(list.empty() ? "" : ", ").append(topic.name).append(" (").append(topic.type).append(")");
  return list.empty() ? "none" : list;
}

RosTopic ChooseTopic(const MessageStore& store, const std::vector<std::string>& types,
                     const std::string& requested, const std::string& option) {
  std::vector<RosTopic> candidates;
  for (const RosTopic& topic : store.topics()) {
    if (std::find(types.begin(), types.end(), topic.type) != types.end() &&
        (requested.empty() || topic.name == requested)) {
      candidates.push_back(topic);
    }
  }
  if (candidates.size() == 1) return candidates.front();
  if (candidates.empty() && requested.empty()) return {};
  std::string list;
  for (const std::string& type : types) list.append(list.empty() ? "" : " or ").append(type);
  if (candidates.empty()) {
    throw std::runtime_error(store.name() + ": " + option + " " + requested +
                             ": there is no such topic of type " + list + "; topics: " + TopicList(store));
  }
  std::string names;
  for (const RosTopic& topic : candidates) names.append(names.empty() ? "" : ", ").append(topic.name);
  throw std::runtime_error(store.name() + ": several topics are of type " + list + "; choose one with " +
                           option + ": " + names);
}

}  // namespace evit::formats
