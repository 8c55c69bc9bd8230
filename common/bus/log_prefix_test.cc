#include "common/bus/log_prefix.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace evit {
namespace {

std::string Error(const std::vector<std::string>& names, const std::string& requested = "") {
  try {
    FindLogPrefix("a.lcmlog", names, requested);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(LogPrefix, ChannelsAreTakenAsPairsNotByTheirEnds) {
  EXPECT_EQ(FindLogPrefix("a", {"EVENTS", "XSENS_IMU", "IMU"}, ""), "");
  EXPECT_EQ(FindLogPrefix("a", {"XSENS_IMU", "OTHER_EVENTS", "cam/EVENTS", "cam/IMU"}, ""), "cam/");
  EXPECT_EQ(FindLogPrefix("a", {"left/EVENTS", "left/IMU", "right/EVENTS", "right/IMU"}, "right/"), "right/");
  EXPECT_EQ(FindLogPrefix("a", {"left/EVENTS", "IMU"}, ""), "left/");
}

TEST(LogPrefix, WhatIsNotClearIsListed) {
  const std::string two = Error({"left/EVENTS", "left/IMU", "right/EVENTS", "right/IMU"});
  EXPECT_NE(two.find("--log-prefix: left/, right/"), std::string::npos) << two;
  EXPECT_NE(Error({"IMU"}).find("no channel EVENTS (it has: IMU)"), std::string::npos);
  EXPECT_NE(Error({"left/EVENTS", "left/IMU"}, "right/").find("--log-prefix: left/"), std::string::npos);
}

}  // namespace
}  // namespace evit
