#pragma once

#include <gtest/gtest.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zstd.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/time/utime.h"

/// Bags as ROS 2 writes them, for tests: messages in CDR, in SQLite and in MCAP.
namespace evit::ros2 {

// Writes CDR as ROS 2 does, in either order of bytes.
class Cdr {
 public:
  explicit Cdr(bool big_endian = false)
      : bytes_(big_endian ? std::string(4, '\0') : std::string("\0\1\0\0", 4)), big_endian_(big_endian) {}
  template <typename Number>
  Cdr& Put(Number value) {
    while ((bytes_.size() - 4) % sizeof value != 0) bytes_ += '\0';
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
    if (big_endian_) std::reverse(bytes.begin(), bytes.end());
    bytes_ += bytes;
    return *this;
  }
  Cdr& Text(const std::string& text) {
    Put(static_cast<std::uint32_t>(text.size() + 1));
    bytes_.append(text.c_str(), text.size() + 1);
    return *this;
  }
  Cdr& Time(Utime t) {
    return Put(static_cast<std::int32_t>(t / kMicrosPerSecond))
        .Put(static_cast<std::uint32_t>(t % kMicrosPerSecond * 1000));
  }
  Cdr& Header(Utime t, const std::string& frame = "camera") { return Time(t).Text(frame); }
  Cdr& Doubles(const std::vector<double>& values) {
    for (const double v : values) Put(v);
    return *this;
  }
  Cdr& Raw(const std::string& bytes) {
    Put(static_cast<std::uint32_t>(bytes.size()));
    bytes_ += bytes;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  bool big_endian_;
};

struct Message {
  std::string topic, bytes;
  Utime t;
};

// Of each topic that the writers below know.
inline const std::map<std::string, std::string> kTypes = {
    {"/cam/events", "event_camera_msgs/msg/EventPacket"},
    {"/cam/array", "dvs_msgs/msg/EventArray"},
    {"/imu", "sensor_msgs/msg/Imu"},
    {"/imu2", "sensor_msgs/msg/Imu"},
    {"/odom2", "nav_msgs/msg/Odometry"},
    {"/odom", "nav_msgs/msg/Odometry"},
    {"/tf", "tf2_msgs/msg/TFMessage"}};

// Of the topics that have messages.
inline std::map<std::string, std::string> TypesOf(const std::vector<Message>& messages) {
  std::map<std::string, std::string> types;
  for (const Message& m : messages) types.insert(*kTypes.find(m.topic));
  return types;
}

inline void WriteSqlite(const std::string& path, const std::vector<Message>& messages) {
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
  const auto run = [&](const std::string& sql) {
    ASSERT_EQ(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sql;
  };
  run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT, "
      "offered_qos_profiles TEXT)");
  run("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB)");
  std::map<std::string, int> ids;
  for (const auto& [topic, type] : TypesOf(messages)) {
    ids[topic] = static_cast<int>(ids.size()) + 1;
    std::string row = "INSERT INTO topics VALUES(" + std::to_string(ids[topic]);
    run(row.append(",'").append(topic).append("','").append(type).append("','cdr','')"));
  }
  run("BEGIN");
  for (const Message& m : messages) {
    sqlite3_stmt* insert = nullptr;
    sqlite3_prepare_v2(db, "INSERT INTO messages(topic_id,timestamp,data) VALUES(?,?,?)", -1, &insert,
                       nullptr);
    sqlite3_bind_int(insert, 1, ids[m.topic]);
    sqlite3_bind_int64(insert, 2, 1000 * m.t);
    sqlite3_bind_blob(insert, 3, m.bytes.data(), static_cast<int>(m.bytes.size()), SQLITE_STATIC);
    ASSERT_EQ(sqlite3_step(insert), SQLITE_DONE);
    sqlite3_finalize(insert);
  }
  run("COMMIT");
  sqlite3_close(db);
}

template <typename Number>
std::string Bytes(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
inline std::string Text(const std::string& text) {
  return Bytes(static_cast<std::uint32_t>(text.size())) + text;
}
inline std::string Record(std::uint8_t type, const std::string& contents) {
  return Bytes(type) + Bytes(std::uint64_t{contents.size()}) + contents;
}

inline std::string Compress(const std::string& compression, const std::string& in) {
  if (compression.empty()) return in;
  const bool lz4 = compression == "lz4";
  std::string out(lz4 ? LZ4F_compressFrameBound(in.size(), nullptr) : ZSTD_compressBound(in.size()), '\0');
  out.resize(lz4 ? LZ4F_compressFrame(out.data(), out.size(), in.data(), in.size(), nullptr)
                 : ZSTD_compress(out.data(), out.size(), in.data(), in.size(), 3));
  return out;
}

// `compression`: of the one chunk; "-": no chunk. With or without a summary.
inline std::string Mcap(const std::vector<Message>& messages, const std::string& compression, bool summary) {
  const std::string magic("\x89MCAP0\r\n", 8);
  std::string definitions, records;
  std::map<std::string, std::uint16_t> ids;
  for (const auto& [topic, type] : TypesOf(messages)) {
    const auto id = static_cast<std::uint16_t>(ids.size() + 1);
    ids[topic] = id;
    definitions += Record(0x03, Bytes(id) + Text(type) + Text("ros2msg") + Text(""));
    definitions += Record(0x04, Bytes(id) + Bytes(id) + Text(topic) + Text("cdr") + Bytes(std::uint32_t{0}));
  }
  records = definitions;
  for (const Message& m : messages)
    records += Record(0x05, Bytes(ids[m.topic]) + Bytes(std::uint32_t{0}) + Bytes(1000 * m.t) +
                                Bytes(1000 * m.t) + m.bytes);
  std::string out = magic + Record(0x01, Text("ros2") + Text("test"));
  if (compression == "-") {
    out += records;
  } else {
    const std::string packed = Compress(compression, records);
    out += Record(0x06, Bytes(std::uint64_t{0}) + Bytes(std::uint64_t{1}) +
                            Bytes(std::uint64_t{records.size()}) + Bytes(std::uint32_t{0}) +
                            Text(compression) + Bytes(std::uint64_t{packed.size()}) + packed);
  }
  out += Record(0x0F, Bytes(std::uint32_t{0}));
  const std::uint64_t at = summary ? out.size() : 0;
  if (summary) out += definitions;
  return out + Record(0x02, Bytes(at) + Bytes(std::uint64_t{0}) + Bytes(std::uint32_t{0})) + magic;
}

}  // namespace evit::ros2
