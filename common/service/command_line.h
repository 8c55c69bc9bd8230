#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/time/utime.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace evit {

/// The options of a program. CLI11 behind them: including it costs ten seconds of compilation, here only
/// once.
class CommandLine {
 public:
  class Option {
   public:
    explicit Option(CLI::Option* option) : option_(option) {}
    Option& Required();
    Option& Range(double min, double max);
    Option& ExistingFiles();
    Option& ShowDefault();
    Option& Excludes(const Option& other);

   private:
    CLI::Option* option_;
  };

  explicit CommandLine(const std::string& description);
  ~CommandLine();

  /// Options as "--name" (or "name": by position). The value stays as it is where the option is not given.
  Option Add(const std::string& name, std::string* value, const std::string& help);
  Option Add(const std::string& name, double* value, const std::string& help);
  Option Add(const std::string& name, std::vector<std::string>* values, const std::string& help);
  Option Add(const std::string& name, std::optional<double>* value, const std::string& help);
  Option Add(const std::string& name, std::optional<Utime>* value, const std::string& help);
  Option AddFlag(const std::string& name, bool* value, const std::string& help);

  /// Nothing: go ahead. Else the exit code: help was asked for and printed, or what is wrong was said on
  /// stderr.
  std::optional<int> Parse(int argc, const char* const* argv);
  /// Exit code, after saying that one of the options is required.
  int Missing(const std::string& options) const;

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace evit
