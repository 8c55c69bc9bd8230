#include "tools/formats/ros/ros_recording.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "tools/formats/event_packet/event_packet_decoder.h"
#include "tools/formats/import/event_filter.h"
#include "tools/formats/ros/message_types.h"
#include "tools/formats/ros/one_recording.h"
#include "tools/formats/ros/topic_choice.h"
#include "tools/formats/ros/transform_poses.h"

namespace evit::formats {
namespace {

template <std::size_t n>
bool IsOneOf(const std::string& type, const char* const (&types)[n]) {
  return std::find(std::begin(types), std::end(types), type) != std::end(types);
}

// What `work` throws comes out with bag, topic and the message's number.
template <typename Work>
auto InMessage(const MessageStore& store, const std::string& topic, std::int64_t number, const Work& work) {
  try {
    return work();
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(store.name() + ": " + topic + ", message " + std::to_string(number) + ": " +
                             error.what());
  }
}

class RosEvents : public EventSource {
 public:
  RosEvents(const MessageStore& store, const RosTopic& topic, const ClockFit* clock, int width, int height)
      : store_(store),
        topic_(topic),
        pass_(store.Read({topic.name})),
        clock_(clock),
        filter_(width, height) {}

  bool Read(EventArray* events) override {
    events->clear();
    RosMessage message;
    while (events->size() == 0 && pass_->Next(&message)) {
      InMessage(store_, topic_.name, ++number_,
                [&] { Decode(RosCursor(message.data, message.size, store_.cdr()), events); });
      filter_.Apply(events);
    }
    return events->size() > 0;
  }
  double share() const override { return pass_->share(); }
  std::string name() const override { return store_.name() + ": " + topic_.name; }
  DropCounts dropped() const override {
    DropCounts dropped = filter_.dropped();
    dropped.unstamped = packets_.unstamped();
    const MessagePass::Loss loss = pass_->LossOf(topic_.name);
    dropped.cut_off = loss.cut_off;
    dropped.lost_share = loss.share;
    return dropped;
  }

 private:
  void Decode(const RosCursor& cursor, EventArray* events) {
    if (!IsOneOf(topic_.type, kEventPacketTypes)) {
      GetEventArray(cursor, events);
      return;
    }
    packets_.Decode(GetEventPacket(cursor), events);
    if (clock_ == nullptr) return;
    for (Utime& t : events->t) t = clock_->ToHost(t);
  }

  const MessageStore& store_;
  RosTopic topic_;
  std::unique_ptr<MessagePass> pass_;
  const ClockFit* clock_;
  EventPacketDecoder packets_;
  EventFilter filter_;
  std::int64_t number_ = 0;
};

}  // namespace

RosRecording::RosRecording(std::unique_ptr<MessageStore> store, const RosTopics& topics)
    : store_(std::move(store)) {
  std::vector<std::string> types(std::begin(kEventPacketTypes), std::end(kEventPacketTypes));
  types.insert(types.end(), std::begin(kEventArrayTypes), std::end(kEventArrayTypes));
  if (topics.take_events) events_ = ChooseTopic(*store_, types, topics.events, "--events-topic");
  if (topics.take_imu) imu_ = ChooseTopic(*store_, {kImuType}, topics.imu, "--imu-topic");
  std::vector<std::string> truths(std::begin(kPoseTypes), std::end(kPoseTypes));
  if (!topics.truth.empty())
    truths.insert(truths.end(), std::begin(kTransformsTypes), std::end(kTransformsTypes));
  if (topics.take_truth) truth_ = ChooseTopic(*store_, truths, topics.truth, "--truth-topic");
  if (!topics.truth_frame.empty() && !IsOneOf(truth_.type, kTransformsTypes))
    throw std::runtime_error(store_->name() + ": --truth-frame " + topics.truth_frame +
                             " chooses a frame of a topic of type tf2_msgs/TFMessage; name that with "
                             "--truth-topic, or leave the option out");
  if (store_->n_files() > 1) RequireOneRecording(store_->Parts(), {events_.name, imu_.name, truth_.name});
  Scan(topics.truth_frame);
}

// One pass for all that is needed before the events: size and clock of the sensor, IMU and truth.
void RosRecording::Scan(const std::string& truth_frame) {
  const bool packets = IsOneOf(events_.type, kEventPacketTypes),
             transforms = IsOneOf(truth_.type, kTransformsTypes);
  std::set<std::string> topics;
  for (const RosTopic& topic : {events_, imu_, truth_}) {
    if (!topic.name.empty()) topics.insert(topic.name);
  }
  std::unique_ptr<MessagePass> pass = store_->Read(topics);
  EventPacketDecoder decoder;
  TransformPoses frames;
  EventArray events;
  std::map<std::string, std::int64_t> n;  // messages of each topic
  std::string encoding;
  RosMessage message;
  while (pass->Next(&message)) {
    InMessage(*store_, message.topic, ++n[message.topic], [&] {
      RosCursor cursor(message.data, message.size, store_->cdr());
      if (message.topic == imu_.name) {
        const ImuSample s = GetImu(&cursor);
        AppendValid(s, s.gyro.allFinite() && s.accel.allFinite(), &streams_.imu, &streams_.dropped_imu);
      } else if (message.topic == truth_.name && transforms) {
        frames.Add(cursor);
      } else if (message.topic == truth_.name) {
        AppendPose(GetPose(truth_.type, &cursor), true, &streams_.truth, &streams_.dropped_truth);
      } else if (packets) {
        const EventPacket packet = GetEventPacket(cursor);
        encoding = packet.encoding;
        info_.width = static_cast<int>(std::min<std::uint32_t>(packet.width, 1 << 15));
        info_.height = static_cast<int>(std::min<std::uint32_t>(packet.height, 1 << 15));
        if (EventPacketDecoder::HostTime(encoding)) return;
        events.clear();
        decoder.Decode(packet, &events);
        if (events.size() > 0) clock_.Add(events.t.front(), packet.stamp);
      } else if (info_.width == 0) {
        events.clear();
        const SensorSizeInMessage size = GetEventArray(cursor, &events);
        info_.width = static_cast<int>(std::min<std::uint32_t>(size.width, 1 << 15));
        info_.height = static_cast<int>(std::min<std::uint32_t>(size.height, 1 << 15));
      }
    });
  }
  NoteLoss(*pass, imu_, &streams_.dropped_imu);
  NoteLoss(*pass, truth_, &streams_.dropped_truth);
  if (transforms) TakeTruth(frames, truth_frame);
  own_clock_ = packets && !EventPacketDecoder::HostTime(encoding);
  clock_.Solve();
  if (!imu_.name.empty()) streams_.imu_name = store_->name() + ": " + imu_.name;
  info_.format = store_->container() + ", " + events_.type + (encoding.empty() ? "" : " (" + encoding + ")");
  info_.sensor = events_.name;
}

// Unless the events of the same file are cut off, too: then their own pass says it.
void RosRecording::NoteLoss(const MessagePass& pass, const RosTopic& topic, DropCounts* dropped) const {
  if (topic.name.empty() || (!events_.name.empty() && pass.LossOf(events_.name).cut_off)) return;
  const MessagePass::Loss loss = pass.LossOf(topic.name);
  dropped->cut_off = loss.cut_off;
  dropped->lost_share = loss.share;
}

void RosRecording::TakeTruth(const TransformPoses& frames, const std::string& frame) {
  try {
    for (const StampedPose& pose : frames.Of(frame))
      AppendPose(pose, true, &streams_.truth, &streams_.dropped_truth);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(store_->name() + ": " + truth_.name + ": " + error.what());
  }
}

std::unique_ptr<EventSource> RosRecording::Events(int width, int height) {
  if (events_.name.empty()) {
    throw std::runtime_error(store_->name() +
                             ": holds no events (EventPacket of event_camera_msgs, EventArray of dvs_msgs or "
                             "prophesee_event_msgs); topics: " +
                             TopicList(*store_));
  }
  return std::make_unique<RosEvents>(*store_, events_, own_clock_ ? &clock_ : nullptr, width, height);
}

ImportStreams RosRecording::Streams() { return streams_; }

}  // namespace evit::formats
