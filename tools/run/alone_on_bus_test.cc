#include "tools/run/alone_on_bus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "common/bus/memory_bus.h"
#include "procman/deputy.h"

namespace evit::run {
namespace {

TEST(AloneOnBus, AnotherDeputyOfTheSameNameIsRefused) {
  const auto hub = MakeMemoryHub();
  const auto theirs = OpenMemoryBus(hub), ours = OpenMemoryBus(hub);
  EXPECT_NO_THROW(RequireAlone(ours.get(), "evit"));
  procman::Deputy deputy(theirs.get(), "evit", {}, {"", ::testing::TempDir()});
  deputy.Tick();  // its PM_INFO
  EXPECT_THAT([&] { RequireAlone(ours.get(), "evit"); },
              ::testing::ThrowsMessage<std::runtime_error>(::testing::HasSubstr("another pipeline")));
}

TEST(AloneOnBus, OtherPrefixesMayShareTheBus) {
  const auto hub = MakeMemoryHub();
  const auto theirs = OpenMemoryBus(hub), ours = OpenMemoryBus(hub);
  procman::Deputy deputy(theirs.get(), "evitleft/", {}, {"", ::testing::TempDir()});
  deputy.Tick();
  EXPECT_NO_THROW(RequireAlone(ours.get(), "evit"));
}

}  // namespace
}  // namespace evit::run
