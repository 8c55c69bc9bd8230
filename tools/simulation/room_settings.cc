#include "tools/simulation/room_settings.h"

namespace evit::simulation {

std::string RoomName(RoomKind room) { return room == RoomKind::kPlain ? "plain" : "furnished"; }

}  // namespace evit::simulation
