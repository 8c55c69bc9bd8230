#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "tools/formats/bag/bag_files.h"

namespace evit::formats {

/// The serialized messages of some topics, over all files in order of the time they were recorded at.
class BagReader {
 public:
  BagReader(const BagFiles& files, const std::set<std::string>& topics);
  ~BagReader();

  /// Goes to the next message; false at the end. Throws std::runtime_error where it cannot be read.
  bool Next();

  const std::string& topic() const { return topic_; }
  /// What `decode` makes of the message's (data, size); what it throws comes out with file, topic and number.
  template <typename Decode>
  auto Decoded(const Decode& decode) const {
    try {
      return decode(bytes_.data(), bytes_.size());
    } catch (const std::exception& error) {
      Fail(error.what());
    }
  }
  double share() const;  // of the messages that were read, 0..1

 private:
  struct Impl;
  [[noreturn]] void Fail(const std::string& what) const;

  std::unique_ptr<Impl> impl_;
  std::string topic_, file_;
  std::map<std::string, std::int64_t> count_;  // messages of each topic so far
  std::vector<std::uint8_t> bytes_;
};

}  // namespace evit::formats
