#include "tools/formats/bag/bag_files.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "common/text/format_text.h"

namespace evit::formats {
namespace {

std::string Join(const std::vector<std::string>& words, const char* gap) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : gap) + word;
  return text;
}

}  // namespace

BagFiles::BagFiles(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    if (!std::filesystem::is_regular_file(path)) throw std::runtime_error(path + ": there is no such file");
    try {
      bags_.push_back(std::make_unique<rosbag::Bag>(path, rosbag::bagmode::Read));
      rosbag::View view(*bags_.back());
      for (const rosbag::ConnectionInfo* c : view.getConnections()) types_[c->topic] = c->datatype;
    } catch (const rosbag::BagUnindexedException&) {
      throw std::runtime_error(path +
                               ": has no index: it was cut off; copy it again, or run rosbag reindex on it "
                               "(`evit import FILE ...` "
                               "reads what is whole of it)");
    } catch (const std::exception& error) {
      throw std::runtime_error(path + ": is not a complete ROS 1 bag (" + error.what() + "); copy it again");
    }
  }
}

BagFiles::~BagFiles() = default;

std::string BagFiles::Names() const {
  std::vector<std::string> names;
  for (const auto& bag : bags_) names.push_back(bag->getFileName());
  return Join(names, ", ");
}

std::vector<BagPart> BagFiles::Parts() const {
  const auto micros = [](const ros::Time& t) { return static_cast<Utime>(t.toNSec() / 1000); };
  std::vector<BagPart> parts;
  for (const auto& bag : bags_) {
    BagPart part{bag->getFileName(), {}};
    rosbag::View all(*bag);
    for (const rosbag::ConnectionInfo* c : all.getConnections()) {
      rosbag::View view(*bag, rosbag::TopicQuery(c->topic));
      if (view.size() > 0) part.topics[c->topic] = {micros(view.getBeginTime()), micros(view.getEndTime())};
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

std::string BagFiles::Topics() const {
  std::vector<std::string> topics;
  for (const auto& [topic, type] : types_)
    topics.push_back(FormatText("%s (%s)", topic.c_str(), type.c_str()));
  return topics.empty() ? "none" : Join(topics, ", ");
}

std::string BagFiles::FindTopic(const std::vector<std::string>& types, const std::string& requested,
                                const std::string& option) const {
  const auto fits = [&](const std::string& type) {
    return std::find(types.begin(), types.end(), type) != types.end();
  };
  if (!requested.empty()) {
    const auto found = types_.find(requested);
    if (found != types_.end() && fits(found->second)) return requested;
    throw std::runtime_error(Names() + ": " + option + " " + requested + ": there is no such topic of type " +
                             Join(types, " or ") + "; topics: " + Topics());
  }
  std::vector<std::string> candidates;
  for (const auto& [topic, type] : types_) {
    if (fits(type)) candidates.push_back(topic);
  }
  if (candidates.size() > 1) {
    throw std::runtime_error(Names() + ": several topics are of type " + Join(types, " or ") +
                             "; choose one with " + option + ": " + Join(candidates, ", "));
  }
  return candidates.empty() ? "" : candidates.front();
}

}  // namespace evit::formats
