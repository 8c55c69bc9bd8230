#pragma once

#include <cstdint>

namespace evit {

/// Says when data is due: maps sensor time to the host's steady clock at a given speed. Times in us.
class Pacer {
 public:
  /// `speed`: 1 real time, 2 twice as fast, 0 everything is due at once.
  explicit Pacer(double speed) : speed_(speed) {}

  /// From now on: data of time `data_us` is due at `now_us`.
  void Start(std::int64_t now_us, std::int64_t data_us) {
    wall0_ = now_us;
    data0_ = data_us;
  }
  /// Changes speed without a jump; data time continues from where it is (from `data_us` where it was
  /// unpaced).
  void SetSpeed(double speed, std::int64_t now_us, std::int64_t data_us) {
    Start(now_us, speed_ > 0 ? DataTime(now_us) : data_us);
    speed_ = speed;
  }

  /// Us from now until data of time `data_us` is due; 0 or less: it is due.
  std::int64_t Until(std::int64_t data_us, std::int64_t now_us) const {
    if (speed_ <= 0) return 0;
    return static_cast<std::int64_t>(static_cast<double>(data_us - data0_) / speed_) - (now_us - wall0_);
  }
  /// Sensor time that is due now. Only where speed > 0.
  std::int64_t DataTime(std::int64_t now_us) const {
    return data0_ + static_cast<std::int64_t>(static_cast<double>(now_us - wall0_) * speed_);
  }
  double speed() const { return speed_; }

 private:
  double speed_;
  std::int64_t wall0_ = 0, data0_ = 0;
};

}  // namespace evit
