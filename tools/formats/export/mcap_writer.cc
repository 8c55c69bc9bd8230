#include "tools/formats/export/mcap_writer.h"

#include <cstdint>
#include <string>

namespace evit::formats {
namespace {

constexpr char kMagic[] = "\x89MCAP0\r\n";

// The message as ROS 2 writes it: a reader needs no other definition.
constexpr char kDefinition[] =
    "std_msgs/Header header\ngeometry_msgs/Pose pose\n"
    "================================================================================\nMSG: std_msgs/Header\n"
    "builtin_interfaces/Time stamp\nstring frame_id\n"
    "================================================================================\nMSG: "
    "builtin_interfaces/Time\n"
    "int32 sec\nuint32 nanosec\n"
    "================================================================================\nMSG: "
    "geometry_msgs/Pose\n"
    "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"
    "================================================================================\nMSG: "
    "geometry_msgs/Point\n"
    "float64 x\nfloat64 y\nfloat64 z\n"
    "================================================================================\nMSG: "
    "geometry_msgs/Quaternion\n"
    "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n";

template <typename Number>
std::string Bytes(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
std::string Text(const std::string& text) { return Bytes(static_cast<std::uint32_t>(text.size())) + text; }

void Record(std::ostream& out, std::uint8_t type, const std::string& contents) {
  out << Bytes(type) << Bytes(std::uint64_t{contents.size()}) << contents;
}

// CDR: the header is 4 + 4 + 4 + 4 bytes ("map" and its zero), so the doubles behind it lie at multiples of
// eight.
std::string PoseStamped(const StampedPose& s) {
  std::string bytes("\0\1\0\0", 4);
  bytes += Bytes(static_cast<std::int32_t>(s.t / kMicrosPerSecond)) +
           Bytes(static_cast<std::uint32_t>(s.t % kMicrosPerSecond * 1000));
  bytes += Bytes(std::uint32_t{4}) + std::string("map", 4);
  for (const double v :
       {s.pose.p.x(), s.pose.p.y(), s.pose.p.z(), s.pose.q.x(), s.pose.q.y(), s.pose.q.z(), s.pose.q.w()})
    bytes += Bytes(v);
  return bytes;
}

}  // namespace

void WritePosesMcap(std::ostream& out, const Trajectory& trajectory) {
  constexpr std::uint16_t kId = 1;
  out.write(kMagic, 8);
  Record(out, 0x01, Text("ros2") + Text("evit"));
  Record(out, 0x03, Bytes(kId) + Text("geometry_msgs/msg/PoseStamped") + Text("ros2msg") + Text(kDefinition));
  Record(out, 0x04, Bytes(kId) + Bytes(kId) + Text("/evit/pose") + Text("cdr") + Bytes(std::uint32_t{0}));
  std::uint32_t sequence = 0;
  for (const StampedPose& s : trajectory) {
    const auto nanoseconds = static_cast<std::uint64_t>(1000 * s.t);
    Record(out, 0x05,
           Bytes(kId) + Bytes(sequence++) + Bytes(nanoseconds) + Bytes(nanoseconds) + PoseStamped(s));
  }
  Record(out, 0x0F, Bytes(std::uint32_t{0}));
  Record(out, 0x02, Bytes(std::uint64_t{0}) + Bytes(std::uint64_t{0}) + Bytes(std::uint32_t{0}));
  out.write(kMagic, 8);
}

}  // namespace evit::formats
