#include "common/service/command_line.h"

#include <CLI/CLI.hpp>

#include "common/service/help_layout.h"

namespace evit {

CommandLine::Option& CommandLine::Option::Required() {
  option_->required();
  return *this;
}

CommandLine::Option& CommandLine::Option::Range(double min, double max) {
  option_->check(CLI::Range(min, max));
  return *this;
}

CommandLine::Option& CommandLine::Option::ExistingFiles() {
  option_->check(CLI::ExistingFile);
  return *this;
}

CommandLine::Option& CommandLine::Option::ShowDefault() {
  option_->capture_default_str();
  return *this;
}

CommandLine::Option& CommandLine::Option::Excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

CommandLine::CommandLine(const std::string& description) : app_(std::make_unique<CLI::App>(description)) {
  LayOutHelp(app_.get());
}

CommandLine::~CommandLine() = default;

CommandLine::Option CommandLine::Add(const std::string& name, std::string* value, const std::string& help) {
  return Option(app_->add_option(name, *value, help));
}

CommandLine::Option CommandLine::Add(const std::string& name, double* value, const std::string& help) {
  return Option(app_->add_option(name, *value, help));
}

CommandLine::Option CommandLine::Add(const std::string& name, std::vector<std::string>* values,
                                     const std::string& help) {
  return Option(app_->add_option(name, *values, help));
}

CommandLine::Option CommandLine::Add(const std::string& name, std::optional<double>* value,
                                     const std::string& help) {
  return Option(app_->add_option(name, *value, help));
}

CommandLine::Option CommandLine::Add(const std::string& name, std::optional<Utime>* value,
                                     const std::string& help) {
  return Option(app_->add_option(name, *value, help));
}

CommandLine::Option CommandLine::AddFlag(const std::string& name, bool* value, const std::string& help) {
  return Option(app_->add_flag(name, *value, help));
}

std::optional<int> CommandLine::Parse(int argc, const char* const* argv) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app_->exit(error);
  }
  return std::nullopt;
}

int CommandLine::Missing(const std::string& options) const { return app_->exit(CLI::RequiredError(options)); }

}  // namespace evit
