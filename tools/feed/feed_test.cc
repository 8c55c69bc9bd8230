#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <random>
#include <thread>

#include "common/bus/codec.h"
#include "common/bus/log_file.h"
#include "common/wire/event_wire.h"
#include "common/wire/imu_wire.h"
#include "tests/helpers/temporary_folder.h"
#include "tools/feed/fake_camera.h"
#include "tools/feed/feed_input.h"
#include "tools/feed/feed_loop.h"

namespace evit::feed {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// What was published, decoded.
struct Published {
  EventArray events;
  std::vector<ImuSample> imu;
  std::vector<Utime> watermarks;
  std::int64_t packets = 0;

  FeedPublisher::Send Sink() {
    return [this](Utime, const std::string& channel, const std::vector<std::uint8_t>& bytes) {
      std::string why;
      if (channel == "EVENTS") {
        event_packet_t packet;
        ASSERT_TRUE(DecodeChecked(bytes.data(), bytes.size(), &packet, &why)) << why;
        EXPECT_EQ(packet.seq, packets++);
        if (packet.n == 0) watermarks.push_back(packet.utime);
        AppendEvents(packet, &events);
      } else {
        imu_batch_t batch;
        ASSERT_TRUE(DecodeChecked(bytes.data(), bytes.size(), &batch, &why)) << why;
        EXPECT_EQ(batch.seq, static_cast<std::int64_t>(imu.size()));
        for (const ImuSample& s : SamplesOf(batch)) imu.push_back(s);
      }
    };
  }
};

// Bytes in pieces of random length.
class PiecesInput : public FeedInput {
 public:
  explicit PiecesInput(std::string bytes) : bytes_(std::move(bytes)) {}
  State Read(std::uint8_t* out, std::size_t capacity, int, std::size_t* n) override {
    *n = std::min({capacity, bytes_.size() - at_, static_cast<std::size_t>(1 + rng_() % 5000)});
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), *n, out);
    at_ += *n;
    return *n > 0 ? State::kData : State::kEnd;
  }
  std::string name() const override { return "pieces"; }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
  std::mt19937 rng_{4};
};

constexpr auto kNeverStop = [] { return false; };
constexpr auto kQuiet = [](const FeedCounts&) {};

TEST(Feed, RecordsInPiecesBecomeEventsAndImu) {
  std::string bytes;
  EventArray events;
  std::vector<ImuSample> imu;
  std::mt19937 rng(1);
  for (Utime t = 1'600'000'000'000'000; events.size() < 50'000; t += rng() % 20) {
    events.push_back(t, rng() % 346, rng() % 260, rng() % 2);
    AppendRecord(t, events.x.back(), events.y.back(), events.p.back(), &bytes);
    if (events.size() % 100 != 0) continue;
    imu.push_back({t, {0.1, -0.2, 1e-9 * static_cast<double>(rng())}, {0, 0, 9.81}});
    AppendRecord(imu.back(), &bytes);
  }
  Published out;
  FeedPublisher publisher({}, Channels(), 7, out.Sink());
  PiecesInput input(bytes);
  RunFeed(&input, &publisher, kNeverStop, kQuiet);
  EXPECT_EQ(out.events.t, events.t);
  EXPECT_EQ(out.events.x, events.x);
  EXPECT_EQ(out.events.y, events.y);
  EXPECT_EQ(out.events.p, events.p);
  ASSERT_EQ(out.imu.size(), imu.size());
  for (std::size_t k = 0; k < imu.size(); ++k) {
    ASSERT_EQ(out.imu[k].t, imu[k].t);
    ASSERT_EQ(out.imu[k].gyro, imu[k].gyro);
    ASSERT_EQ(out.imu[k].accel, imu[k].accel);
  }
}

TEST(Feed, WhatIsLateOutsideOrNotANumberIsCountedAndDropped) {
  std::string bytes;
  AppendRecord(1000, 5, 5, 1, &bytes);
  AppendRecord(999, 5, 5, 1, &bytes);
  AppendRecord(1001, 346, 5, 1, &bytes);
  AppendRecord({1000, {NAN, 0, 0}, {0, 0, 9.81}}, &bytes);
  AppendRecord({1000, {0, 0, 0}, {0, 0, 9.81}}, &bytes);
  AppendRecord({1000, {0, 0, 0}, {0, 0, 9.81}}, &bytes);
  Published out;
  FeedOptions options;
  options.width = 346;
  options.height = 260;
  FeedPublisher publisher(options, Channels(), 7, out.Sink());
  PiecesInput input(bytes);
  RunFeed(&input, &publisher, kNeverStop, kQuiet);
  EXPECT_EQ(out.events.t, std::vector<Utime>{1000});
  EXPECT_EQ(out.imu.size(), 1U);
  EXPECT_EQ(publisher.counts().late, 2);
  EXPECT_EQ(publisher.counts().outside, 1);
  EXPECT_EQ(publisher.counts().invalid, 1);
}

TEST(Feed, ASilentCameraIsSaidToBeSilent) {
  std::string bytes;
  AppendRecord(1000, 5, 5, 1, &bytes);
  for (Utime t = 5'000; t <= 500'000; t += 5'000) AppendRecord({t, {0, 0, 0}, {0, 0, 9.81}}, &bytes);
  Published out;
  FeedPublisher publisher({}, Channels(), 7, out.Sink());
  RecordParser parser;
  EventArray events;
  std::vector<ImuSample> imu;
  parser.Parse(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), &events, &imu);
  publisher.Add(events, {}, 0);
  publisher.Flush();
  for (const ImuSample& s : imu) publisher.Add({}, {s}, 0);
  ASSERT_FALSE(out.watermarks.empty());
  EXPECT_GE(out.watermarks.back(), 450'000);
  EXPECT_LT(out.watermarks.back(), 500'000);  // events may be a little behind the IMU
}

TEST(Feed, ClocksAreAlignedByTheSmallestDelayOfArrival) {
  std::mt19937 rng(9);
  Published out;
  FeedOptions options;
  options.align_clocks = true;
  FeedPublisher publisher(options, Channels(), 7, out.Sink());
  constexpr Utime kImuAhead = 123'456'789;  // of the clock of the events
  for (Utime now = 0; now < 2'000'000; now += 1000) {
    EventArray events;
    events.push_back(now, 1, 1, 1);
    std::vector<ImuSample> imu;
    if (now % 5000 == 0) imu.push_back({now + kImuAhead, {0, 0, 0}, {0, 0, 9.81}});
    publisher.Add(events, imu, 1'000'000'000 + now + static_cast<Utime>(rng() % 900));
  }
  publisher.Close();
  EXPECT_NEAR(static_cast<double>(publisher.counts().imu_offset), -static_cast<double>(kImuAhead), 200);
  ASSERT_EQ(out.imu.size(), 400U);  // none is lost while the clocks are compared
  EXPECT_NEAR(static_cast<double>(out.imu[10].t), 50'000, 200);
}

TEST(Feed, OtherBytesAreRefusedWithTheirPlace) {
  std::string bytes;
  AppendRecord(1000, 5, 5, 1, &bytes);
  for (const auto& [rest, why] :
       {std::pair(std::string("hello, this is text"), "byte 16 of the stream: a record of kind 104"),
        std::pair(std::string("\1\1"), "ended within a record (2 bytes)")}) {
    Published out;
    FeedPublisher publisher({}, Channels(), 7, out.Sink());
    PiecesInput input(bytes + rest);
    EXPECT_THAT([&] { RunFeed(&input, &publisher, kNeverStop, kQuiet); },
                ThrowsMessage<std::runtime_error>(HasSubstr(why)));
    EXPECT_EQ(out.events.size(), why[0] == 'e' ? 1U : 0U);
  }
}

TEST(Feed, ADriverConnectsByTcp) {
  int port = 20'000 + getpid() % 20'000;
  std::unique_ptr<FeedInput> input;
  while (!input) {
    try {
      input = ListenTcp(port);
    } catch (const std::runtime_error&) {
      ++port;  // taken
    }
  }
  std::thread driver([port] {
    const int fd = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ASSERT_EQ(connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    std::string bytes;
    for (Utime t = 0; t < 10'000; ++t) AppendRecord(t, 1, 2, 1, &bytes);
    for (std::size_t at = 0; at < bytes.size();)
      at += static_cast<std::size_t>(write(fd, bytes.data() + at, bytes.size() - at));
    close(fd);
  });
  Published out;
  FeedPublisher publisher({}, Channels(), 7, out.Sink());
  RunFeed(input.get(), &publisher, kNeverStop, kQuiet);
  driver.join();
  EXPECT_EQ(out.events.size(), 10'000U);
}

TEST(Feed, DatagramsHoldWholeRecords) {
  int port = 20'000 + getpid() % 20'000;
  std::unique_ptr<FeedInput> input;
  while (!input) {
    try {
      input = ListenUdp(port);
    } catch (const std::runtime_error&) {
      ++port;  // taken
    }
  }
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  for (Utime t = 0; t < 10; ++t) {
    std::string bytes;
    for (Utime k = 0; k < 50; ++k) AppendRecord(50 * t + k, 1, 2, 1, &bytes);
    ASSERT_EQ(sendto(fd, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&address),
                     sizeof address),
              static_cast<ssize_t>(bytes.size()));
  }
  close(fd);
  Published out;
  FeedPublisher publisher({}, Channels(), 7, out.Sink());
  RunFeed(
      input.get(), &publisher, [&] { return out.events.size() == 500; }, kQuiet);
  EXPECT_EQ(out.events.size(), 500U);
}

TEST(Feed, AFakeCameraSendsWhatItsLogHolds) {
  const TemporaryFolder folder("feed");
  EventArray events;
  for (Utime t = 0; t < 100'000; t += 7) events.push_back(t, 1, 2, 1);
  {
    LogWriter log(folder.File("a.lcmlog"));
    std::vector<std::uint8_t> buffer;
    std::int64_t seq = 0;
    for (std::size_t begin = 0; begin < events.size();) {
      begin = EncodePacket(events, begin, 3, seq++, &buffer);
      log.Write(events.t[begin - 1], "EVENTS", buffer.data(), buffer.size());
    }
    log.Close();
  }
  for (const bool realtime : {false, true}) {
    Published out;
    FeedPublisher publisher({}, Channels(), 7, out.Sink());
    RunFeed(OpenFakeCamera(folder.File("a.lcmlog"), realtime).get(), &publisher, kNeverStop, kQuiet);
    EXPECT_EQ(out.events.t, events.t);
  }
}

}  // namespace
}  // namespace evit::feed
