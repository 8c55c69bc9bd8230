#pragma once

#include <chrono>

namespace evit {

/// A duration of the host's clock in ms, as STATUS and messages show it.
inline double Milliseconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

}  // namespace evit
