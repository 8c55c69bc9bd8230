#include "tools/formats/bag/bag_reader.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <stdexcept>

namespace evit::formats {
struct BagReader::Impl {
  rosbag::View view;
  rosbag::View::iterator at;
  std::int64_t n_read = 0, n = 0;
  std::map<const void*, std::string> files;  // connection to its file: a message does not know it
};

BagReader::BagReader(const BagFiles& files, const std::set<std::string>& topics)
    : impl_(std::make_unique<Impl>()) {
  const auto selected = [topics](const rosbag::ConnectionInfo* c) { return topics.count(c->topic) > 0; };
  for (const auto& bag : files.bags()) {
    impl_->view.addQuery(*bag, selected);
    rosbag::View own(*bag);
    for (const rosbag::ConnectionInfo* c : own.getConnections())
      impl_->files[c->header.get()] = bag->getFileName();
  }
  impl_->n = impl_->view.size();
  impl_->at = impl_->view.begin();
}

BagReader::~BagReader() = default;

bool BagReader::Next() {
  if (impl_->at == impl_->view.end()) return false;
  const rosbag::MessageInstance& message = *impl_->at;
  topic_ = message.getTopic();
  file_ = impl_->files[message.getConnectionHeader().get()];
  ++count_[topic_];
  try {
    const std::uint32_t size = message.size();
    if (size > kMaxMessage) throw std::runtime_error("says it has " + std::to_string(size) + " bytes");
    bytes_.resize(size);
    ros::serialization::OStream stream(bytes_.data(), size);
    message.write(stream);
  } catch (const std::exception& error) {
    Fail(std::string(error.what()) + ": the bag is damaged; copy it again");
  }
  ++impl_->at;
  ++impl_->n_read;
  return true;
}

double BagReader::share() const {
  return impl_->n > 0 ? static_cast<double>(impl_->n_read) / static_cast<double>(impl_->n) : 1;
}

void BagReader::Fail(const std::string& what) const {
  throw std::runtime_error(file_ + ": " + topic_ + ", message " + std::to_string(count_.at(topic_)) + ": " +
                           what);
}

}  // namespace evit::formats
