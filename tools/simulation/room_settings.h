#pragma once

#include <cstdint>
#include <string>

namespace evit::simulation {

enum class RoomKind {
  kFurnished,
  kPlain,  // almost no texture: no posters, every surface of one grey, few things on tables and shelves
};

struct RoomSettings {
  std::uint64_t seed = 1;
  RoomKind kind = RoomKind::kFurnished;
};

/// "furnished" or "plain".
std::string RoomName(RoomKind room);

}  // namespace evit::simulation
