#include "tools/evit/place_options.h"

namespace evit::commands {

void AddPlaceOptions(CLI::App* command, run::PlaceTexts* place) {
  command->add_option("--near", place->near,
                      "Where the place is looked for: \"x y z radius\", m (default: in the whole map)");
  command->add_option("--height", place->height, "At which heights of the body: \"low:high\", m");
  command->add_option("--yaw", place->yaw,
                      "With which heading of the body's x axis: \"degrees:tolerance\", from the map's x "
                      "towards its y");
}

}  // namespace evit::commands
