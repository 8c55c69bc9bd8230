#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <random>
#include <string>

#include "common/files/decimal_time.h"
#include "tests/helpers/imported_log.h"
#include "tools/formats/rpg/rpg_import.h"

namespace evit::formats {

/// Half a second from t = 0 on, as RPG's recordings begin there: events with 30 ms of silence, IMU at 1 kHz.
class RpgImportTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(In(""));
    std::mt19937 rng(3);
    std::ofstream events(In("events.txt")), imu(In("imu.txt")), truth(In("groundtruth.txt"));
    for (Utime t = 0; t < 500'000; t += t == 200'000 ? 30'000 : rng() % 9) {
      made_.events.push_back(t, rng() % 240, rng() % 180, rng() % 2);
      events << DecimalSeconds(t) << "000 " << made_.events.x.back() << ' ' << made_.events.y.back() << ' '
             << int{made_.events.p.back()} << '\n';
    }
    for (int k = 0; k < 500; ++k) {
      const ImuSample s{Utime{1000} * k + 3, {k / 8.0, 0.1, -2e-5}, {9.81, 1.0 / 3, -0.0625 * k}};
      made_.imu.push_back(s);
      imu << DecimalSeconds(s.t) << std::setprecision(17);
      for (const auto& v : {s.accel, s.gyro}) imu << ' ' << v.x() << ' ' << v.y() << ' ' << v.z();
      imu << '\n';
    }
    for (int k = 0; k < 100; ++k) {
      const double h = k % 2 == 0 ? 0.5 : -0.5;  // exactly of length 1
      made_.truth.push_back({Utime{5000} * k, {Eigen::Quaterniond(0.5, h, 0.5, 0.5), {0.125 * k, 1, -0.3}}});
      truth << TumLine(made_.truth.back()) << '\n';
    }
    std::ofstream(In("calib.txt"))
        << "199.092366542 198.82882047 132.192071378 110.712660011 -0.368436311798 "
           "0.150947243557 -0.000296130534385 -0.000759431726241 0.0\n";
    job_.folder = In("");
    job_.out = (folder_ / "out.lcmlog").string();
    job_.any_imu = true;  // made-up numbers
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string In(const std::string& name) const { return (folder_ / "in" / name).string(); }
  ImportSummary Import() const {
    return ImportRpg(job_, [](double) {});
  }
  void Append(const std::string& name, const std::string& text) const {
    std::ofstream(In(name), std::ios::app) << text;
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(::testing::TempDir()) / ("rpg_" + std::to_string(getpid()));
  ImportedLog made_;
  RpgImport job_;
};

}  // namespace evit::formats
