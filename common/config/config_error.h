#pragma once

#include <stdexcept>

namespace evit {

/// A configuration file that cannot be used; what() names file, line and field, and the remedy.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace evit
