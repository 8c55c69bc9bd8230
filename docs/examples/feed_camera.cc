// A driver for `evit feed` in C++: half a second of made-up events and IMU samples, on standard output.
//   g++ -O2 feed_camera.cc -o feed_camera && ./feed_camera | evit feed ...
#include <cstdint>
#include <cstdio>

#pragma pack(push, 1)
struct EventRecord {  // 16 bytes, little-endian
  std::uint8_t kind = 1, polarity;
  std::uint16_t x, y, zero = 0;
  std::int64_t t_us;
};
struct ImuRecord {  // 64 bytes: rad/s, m/s^2 (at rest: +9.81 upwards)
  std::uint8_t kind = 2, zero[7] = {};
  std::int64_t t_us;
  double gyro[3], accel[3];
};
#pragma pack(pop)

int main() {
  for (std::int64_t t = 0; t < 500'000;
       t += 100) {  // us; replace this loop by what your camera's library calls you with
    EventRecord event;
    event.t_us = t;
    event.x = static_cast<std::uint16_t>(t / 1000 % 346);
    event.y = 100;
    event.polarity = static_cast<std::uint8_t>(t / 100 % 2);
    std::fwrite(&event, sizeof event, 1, stdout);
    if (t % 5'000 != 0) continue;
    ImuRecord sample;
    sample.t_us = t;
    for (int k = 0; k < 3; ++k) sample.gyro[k] = k == 2 ? 0.1 : 0, sample.accel[k] = k == 2 ? 9.81 : 0;
    std::fwrite(&sample, sizeof sample, 1, stdout);
  }
  return 0;
}
