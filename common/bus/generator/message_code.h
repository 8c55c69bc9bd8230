#pragma once

#include <string>
#include <vector>

#include "common/bus/generator/lcm_file.h"

namespace evit::generator {

/// C++ about the messages of one package, so that a new .lcm file is all it takes. Messages are the types
/// that no other type contains. Both functions throw std::runtime_error "FILE:LINE: ..." where a type is
/// beyond what the checks can do, or where the comment of a count does not say "at most NUMBER".

/// <PACKAGE/messages.hpp>: includes them all, lists them (PACKAGE_MESSAGES(X), AllMessages<List>), and has
/// VisitArraysOf() for each.
std::string MessagesHeader(const std::vector<MessageType>& types);

/// LayoutOf<MESSAGE>() of common/bus/wire_layout.h for each message.
std::string LayoutsSource(const std::vector<MessageType>& types);

}  // namespace evit::generator
