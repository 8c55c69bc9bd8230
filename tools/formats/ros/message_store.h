#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "common/time/utime.h"

namespace evit::formats {

/// A serialized message, valid until the next one is asked for.
struct RosMessage {
  std::string topic;
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// A pass over the messages of some topics of a bag, in the order of the time they were recorded at.
class MessagePass {
 public:
  virtual ~MessagePass() = default;
  /// False at the end. Throws std::runtime_error naming the file where it is damaged.
  virtual bool Next(RosMessage* message) = 0;
  virtual double share() const = 0;  // of the bag that was read, 0..1
  /// At the end: whether the file ends within a record. What is before it was read.
  virtual bool cut_off() const { return false; }
  /// Of such a file the share that is missing, 0..1; 0: it does not say.
  virtual double lost_share() const { return 0; }
  struct Loss {
    bool cut_off = false;
    double share = 0;  // that is missing
  };
  /// The same of a topic alone, where the pass is over several files.
  virtual Loss LossOf(const std::string& /*topic*/) const { return {cut_off(), lost_share()}; }
};

struct RosTopic {
  std::string name, type;  // type as ROS 1 writes it: package/Type
};

/// When messages of a topic were recorded, the first and the last one.
struct TopicSpan {
  Utime begin = 0, end = 0;
};

/// One file of a bag, and the topics that it holds messages of.
struct BagPart {
  std::string file;
  std::map<std::string, TopicSpan> topics;
  bool cut_off = false;  // it went on longer

  /// Widens the topic's span to a message that was recorded at `t`.
  void Cover(const std::string& topic, Utime t) {
    TopicSpan& span = topics.try_emplace(topic, TopicSpan{t, t}).first->second;
    span.begin = std::min(span.begin, t), span.end = std::max(span.end, t);
  }
};

/// A bag of whatever container: what topics it has, and passes over them.
class MessageStore {
 public:
  virtual ~MessageStore() = default;
  virtual std::string name() const = 0;       // file or folder, for messages
  virtual std::string container() const = 0;  // for people, e.g. "MCAP"
  virtual bool cdr() const = 0;  // serialized by ROS 2's rules (aligned); otherwise by ROS 1's (packed)
  virtual const std::vector<RosTopic>& topics() const = 0;
  virtual std::unique_ptr<MessagePass> Read(const std::set<std::string>& topics) const = 0;
  virtual std::size_t n_files() const { return 1; }
  /// What each of its files spans; may go through all of them.
  virtual std::vector<BagPart> Parts() const = 0;
};

/// No driver sends more at once; a forged length must not decide how much memory is reserved.
inline constexpr std::size_t kMaxMessage = 1U << 28;  // bytes

/// package/msg/Type as ROS 1 writes it: package/Type.
std::string Ros1TypeName(const std::string& type);

}  // namespace evit::formats
