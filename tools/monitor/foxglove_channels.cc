#include "tools/monitor/foxglove_channels.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>

#include <nlohmann/json.hpp>

namespace evit::monitor {
namespace {

using nlohmann::json;

std::string Base64(const std::string& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      three = three << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : kDigits[three >> (18 - 6 * k) & 63U];
    }
  }
  return text;
}

// The schema's file and those it imports, as the protocol wants them.
std::string SchemaOf(const google::protobuf::Descriptor* type) {
  google::protobuf::FileDescriptorSet files;
  for (int i = 0; i < type->file()->dependency_count(); ++i) {
    type->file()->dependency(i)->CopyTo(files.add_file());
  }
  type->file()->CopyTo(files.add_file());
  return Base64(files.SerializeAsString());
}

json Channel(FoxgloveChannel id, const char* topic, const google::protobuf::Descriptor* type) {
  return {{"id", static_cast<std::uint32_t>(id)}, {"topic", topic},           {"encoding", "protobuf"},
          {"schemaName", type->full_name()},      {"schema", SchemaOf(type)}, {"schemaEncoding", "protobuf"}};
}

void SetTime(std::int64_t utime, google::protobuf::Timestamp* to) {
  to->set_seconds(utime / 1'000'000);
  to->set_nanos(static_cast<std::int32_t>(utime % 1'000'000 * 1000));
}

void SetVector(const Eigen::Vector3d& v, foxglove::Vector3* to) {
  to->set_x(v.x());
  to->set_y(v.y());
  to->set_z(v.z());
}

void SetRotation(const Eigen::Quaterniond& q, foxglove::Quaternion* to) {
  to->set_x(q.x());
  to->set_y(q.y());
  to->set_z(q.z());
  to->set_w(q.w());
}

foxglove::Log MakeLog(std::int64_t utime, foxglove::Log::Level level, const std::string& name,
                      const std::string& message) {
  foxglove::Log log;
  SetTime(utime, log.mutable_timestamp());
  log.set_level(level);
  log.set_name(name);
  log.set_message(message);
  return log;
}

// proto3 strings are UTF-8; what comes over the bus may be anything.
std::string Ascii(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) > '~' || static_cast<unsigned char>(c) < ' ') c = '?';
  }
  return text;
}

}  // namespace

std::string FoxgloveServerInfo(const std::string& session) {
  return json{
      {"op", "serverInfo"}, {"name", "evit monitor"}, {"capabilities", json::array()}, {"sessionId", session}}
      .dump();
}

std::string FoxgloveAdvertisement() {
  const json channels = {Channel(FoxgloveChannel::kPose, "/pose", foxglove::PoseInFrame::descriptor()),
                         Channel(FoxgloveChannel::kTransform, "/tf", foxglove::FrameTransform::descriptor()),
                         Channel(FoxgloveChannel::kTruth, "/truth", foxglove::PoseInFrame::descriptor()),
                         Channel(FoxgloveChannel::kMap, "/map", foxglove::PointCloud::descriptor()),
                         Channel(FoxgloveChannel::kSurface, "/surface", foxglove::RawImage::descriptor()),
                         Channel(FoxgloveChannel::kLog, "/diagnostics", foxglove::Log::descriptor())};
  return json{{"op", "advertise"}, {"channels", channels}}.dump();
}

foxglove::PoseInFrame ToFoxglovePose(std::int64_t utime, const SE3& T_map_body) {
  foxglove::PoseInFrame pose;
  SetTime(utime, pose.mutable_timestamp());
  pose.set_frame_id("map");
  SetVector(T_map_body.p, pose.mutable_pose()->mutable_position());
  SetRotation(T_map_body.q, pose.mutable_pose()->mutable_orientation());
  return pose;
}

foxglove::FrameTransform ToFoxgloveTransform(std::int64_t utime, const SE3& T_map_body) {
  foxglove::FrameTransform transform;
  SetTime(utime, transform.mutable_timestamp());
  transform.set_parent_frame_id("map");
  transform.set_child_frame_id("body");
  SetVector(T_map_body.p, transform.mutable_translation());
  SetRotation(T_map_body.q, transform.mutable_rotation());
  return transform;
}

foxglove::PointCloud ToFoxgloveMap(std::int64_t utime, const MapStore& map) {
  foxglove::PointCloud cloud;
  SetTime(utime, cloud.mutable_timestamp());
  cloud.set_frame_id("map");
  cloud.mutable_pose()->mutable_position();
  SetRotation(Eigen::Quaterniond::Identity(), cloud.mutable_pose()->mutable_orientation());
  cloud.set_point_stride(3 * sizeof(float));
  std::uint32_t offset = 0;
  for (const char* name : {"x", "y", "z"}) {
    foxglove::PackedElementField* field = cloud.add_fields();
    field->set_name(name);
    field->set_offset(offset);
    field->set_type(foxglove::PackedElementField::FLOAT32);
    offset += sizeof(float);
  }
  const auto& points = map.points();
  cloud.set_data(points.data(), points.size() * sizeof(points[0]));
  return cloud;
}

foxglove::RawImage ToFoxgloveImage(const keyframe_t& keyframe) {
  foxglove::RawImage image;
  SetTime(keyframe.utime, image.mutable_timestamp());
  image.set_frame_id("camera");
  image.set_width(static_cast<std::uint32_t>(keyframe.width));
  image.set_height(static_cast<std::uint32_t>(keyframe.height));
  image.set_encoding("mono8");
  image.set_step(static_cast<std::uint32_t>(keyframe.width));
  image.set_data(keyframe.surface.data(), keyframe.surface.size());
  return image;
}

foxglove::Log ToFoxgloveLog(std::int64_t utime, const tracker_mode_t& mode) {
  static constexpr const char* kNames[] = {"bootstrapping", "tracking", "lost"};
  const bool lost = mode.mode == tracker_mode_t::LOST;
  return MakeLog(utime, lost ? foxglove::Log::WARNING : foxglove::Log::INFO, "tracker",
                 std::string(kNames[mode.mode]) + ": " + Ascii(mode.reason));
}

foxglove::Log ToFoxgloveLog(std::int64_t utime, const service_status_t& status) {
  const bool failed = status.state == "failed";
  const bool degraded = status.state == "degraded";
  return MakeLog(utime,
                 failed     ? foxglove::Log::ERROR
                 : degraded ? foxglove::Log::WARNING
                            : foxglove::Log::INFO,
                 Ascii(status.service), Ascii(status.state + ": " + status.detail));
}

}  // namespace evit::monitor
