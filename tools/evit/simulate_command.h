#pragma once

namespace CLI {
class App;
}

namespace evit::commands {

/// Adds `simulate` to the program: an event camera and an IMU in a rendered room, written in VECtor's layout.
void AddSimulateCommand(CLI::App* app);

}  // namespace evit::commands
