#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "common/config/config_error.h"

namespace evit::test {

/// A test with a folder of its own for configuration files.
class ConfigFilesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(::testing::TempDir()) /
              (std::string("evit_") + test->test_suite_name() + "_" + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string Path(const std::string& name) const { return folder_ / name; }

  /// Writes a file of the folder; its path.
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(Path(name)) << text;
    return Path(name);
  }

  /// Expects that `load` refuses the file, naming it (with `place`, such as ":7:3") first and then each of
  /// the words.
  template <typename Load>
  void ExpectRefused(Load load, const std::string& path, const std::string& place,
                     const std::vector<std::string>& words) const {
    try {
      load(path);
      ADD_FAILURE() << "not refused; a complaint with " << words.front() << " is expected";
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), ::testing::StartsWith(path + place + ":"));
      for (const std::string& word : words) EXPECT_THAT(error.what(), ::testing::HasSubstr(word));
    }
  }

 private:
  std::filesystem::path folder_;
};

inline std::string ReadText(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// `text` with its first occurrence of `from` made `to`.
inline std::string Edited(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace evit::test
