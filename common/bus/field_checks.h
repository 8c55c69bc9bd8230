#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/bus/limits.h"

namespace evit {

/// Collects the first thing that is wrong with a message. Each check says nothing once one has failed.
class FieldChecks {
 public:
  explicit FieldChecks(std::string* why) : why_(why) {}

  FieldChecks& That(bool holds, const char* otherwise) {
    if (ok_ && !holds) {
      ok_ = false;
      if (why_ != nullptr) *why_ = otherwise;
    }
    return *this;
  }

  /// utime, seq and epoch, which open every message.
  template <typename Message>
  FieldChecks& Stamp(const Message& m) {
    // The upper bound leaves room for arithmetic on untrusted values.
    return Time("utime", m.utime).That(m.seq >= 0 && m.seq < kMaxSequence, "seq is out of range");
  }

  FieldChecks& Time(const char* name, std::int64_t utime) {
    return Named(name, utime >= -kMaxTime && utime <= kMaxTime, " is out of range");
  }

  template <typename Number>
  FieldChecks& Finite(const char* name, const Number* values, std::size_t n) {
    bool finite = true;
    for (std::size_t i = 0; i < n; ++i) finite = finite && std::isfinite(values[i]);
    return Named(name, finite, " is not finite");
  }
  template <std::size_t kN>
  FieldChecks& Finite(const char* name, const double (&values)[kN]) {
    return Finite(name, values, kN);
  }
  template <std::size_t kRows, std::size_t kColumns>
  FieldChecks& Finite(const char* name, const double (&values)[kRows][kColumns]) {
    return Finite(name, &values[0][0], kRows * kColumns);
  }
  FieldChecks& Finite(const char* name, double value) { return Finite(name, &value, 1); }
  template <typename Number>
  FieldChecks& Finite(const char* name, const std::vector<std::vector<Number>>& rows) {
    for (const auto& row : rows) Finite(name, row.data(), row.size());
    return *this;
  }

  FieldChecks& Unit(const char* name, const double (&q)[4]) {
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    return Named(name, std::abs(norm - 1.0) <= 1e-3, " is not a unit quaternion");  // false for NaN
  }

  /// position and orientation of any message that has them.
  template <typename Message>
  FieldChecks& Pose(const Message& m) {
    return Finite("position", m.position).Unit("orientation", m.orientation);
  }

  FieldChecks& Increasing(const char* name, const std::vector<std::int64_t>& times) {
    bool increasing = true;
    for (std::size_t i = 1; i < times.size(); ++i) increasing = increasing && times[i - 1] < times[i];
    return Named(name, increasing, " does not increase");
  }

  bool ok() const { return ok_; }

 private:
  FieldChecks& Named(const char* name, bool holds, const char* what) {
    if (ok_ && !holds) {
      ok_ = false;
      if (why_ != nullptr) *why_ = std::string(name) + what;
    }
    return *this;
  }

  std::string* why_;
  bool ok_ = true;
};

}  // namespace evit
