#pragma once

namespace evit::run {

/// What a pipeline's services have used since they were started, s.
struct ServiceTime {
  double computing = 0;  // on a processor
  double waiting = 0;    // ready to, but others had the processors
};

/// Whether a pipeline that says nothing is stuck, on a host of any speed and load: what counts is how long
/// its services have had nothing to do, not how long they take for it.
class StallWatch {
 public:
  /// The tracker said something new.
  void Progress();
  /// Call about once a second: seconds of a steady clock, and what the services have used until then.
  void Tick(double now, const ServiceTime& used);

  /// Seconds since the last progress in which the services were idle.
  double idle() const { return idle_; }
  /// No progress to be hoped for: idle for a minute, or ten minutes of computing that lead to nothing.
  bool stuck() const { return idle_ > kIdle || computed_ > kComputing; }

  static constexpr double kIdle = 60, kComputing = 600;  // s

 private:
  double idle_ = 0, computed_ = 0;  // s, since the last progress
  double now_ = -1;
  ServiceTime used_;
};

}  // namespace evit::run
