#pragma once

#include <string>
#include <vector>

#include "tools/formats/ros/message_store.h"

namespace evit::formats {

/// The topic of one of these types: `requested`, or, where that is empty, the only one there is; without a
/// name where there is none. Otherwise throws std::runtime_error that lists the topics and names `option`.
RosTopic ChooseTopic(const MessageStore& store, const std::vector<std::string>& types,
                     const std::string& requested, const std::string& option);

/// All topics with their types, for messages.
std::string TopicList(const MessageStore& store);

}  // namespace evit::formats
