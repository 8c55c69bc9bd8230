#include "common/service/stop_signals.h"

#include <gtest/gtest.h>

#include <initializer_list>

namespace evit {
namespace {

TEST(StopSignals, InterruptTerminationAndHangUpAreNoticed) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const StopSignals signals;
    EXPECT_FALSE(signals.received());
    ::raise(signal);
    EXPECT_TRUE(signals.received()) << signal;
  }
}

TEST(StopSignals, AHangUpThatWasIgnoredStaysIgnored) {
  const auto before = ::signal(SIGHUP, SIG_IGN);  // as nohup does
  {
    const StopSignals signals;
    ::raise(SIGHUP);
    EXPECT_FALSE(signals.received());
  }
  ::signal(SIGHUP, before);
}

}  // namespace
}  // namespace evit
