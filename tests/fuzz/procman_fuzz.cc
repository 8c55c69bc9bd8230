// Deployment files, their command lines, and two small languages: LCM URLs and EVIT_BUS_FAULTS. The first
// byte chooses.
#include <stdexcept>

#include "common/bus/faulty_bus.h"
#include "common/bus/lcm_url.h"
#include "procman/command_line.h"
#include "procman/deployment.h"
#include "tests/fuzz/choice.h"

namespace {

void CheckCommandLine(const std::string& text) {
  const auto value = [](const std::string&) -> std::optional<std::string> { return "a b"; };
  const evit::procman::CommandLine line = evit::procman::SplitCommandLine(text, value);
  if (evit::procman::SplitCommandLine(evit::procman::JoinCommandLine(line.words), value).words != line.words)
    __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data + 1), size - 1);
  try {
    switch (evit::fuzz::Choice(data[0], 4)) {
      case 0:
        evit::procman::ParseDeployment(text, "fuzz");
        break;
      case 1:
        CheckCommandLine(text);
        break;
      case 2:
        evit::ParseBusFaults(text);
        break;
      default:
        evit::ParseLcmUrl(text);
    }
  } catch (const std::runtime_error&) {
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
