#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "icd/mapping.hpp"
#include "icd/robot_name.hpp"
#include "icd/uri.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "pace/rate_limit.hpp"
#include "queues/lattice.hpp"
#include "queues/marker_queue.hpp"
#include "queues/stamps.hpp"
#include "queues/state_queue.hpp"
#include "store/contents.hpp"
#include "store/directory.hpp"
#include "store/frame.hpp"
#include "store/log.hpp"

namespace adit::journal {

/// Kinds of records. The numbers are in files and must not change.
enum class RecordKind : std::uint8_t {
  Clock = 1,         // a boot, a monotonic time and its stamp
  LifeBegins = 2,    // a process started; its predecessor's messages in flight count as not delivered
  Senders = 18,      // senders' clocks
  StateSent = 5,     // poses by robot
  StateDone = 6,     // delivered or rejected
  StateBack = 7,     // queued again
  MarkersSent = 10,  // markers by ns, id and action
  MarkersDone = 11,
  MarkersBack = 12,
  Pace = 13,     // the next request of a URI, and its learned spacing
  Stamp = 14,    // the last stamp of a URI
  Grids = 16,    // the extent of the posted grids of a name
  Poses = 19,    // an accepted /state/update
  Heard = 20,    // when a robot posted, and how often it posts
  Markers = 21,  // an accepted /markers/update
};

/// The gateway's stamp clock at one time of a boot.
struct Clock {
  std::string boot;  // host::boot()
  pace::Instant at{};
  double stamp = 0;
  double step_to = 0, step_by = 0;  // dispatch::ClockStep at the start of this boot
  double off = 0, off_since = 0;    // forward::Clocks::Deviation
};

/// When a robot was last heard, by the stamp clock, and how often it sends.
struct Heard {
  static constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
  /// For one kind of data; NaN: never.
  struct Times {
    double accepted = kNever, forwarded = kNever;
  };
  std::string robot;             // "": merged maps
  std::uint64_t messages = 0;    // alarms::Habit
  double gap = 0, last = 0;      // as `messages`
  std::array<Times, 3> kinds{};  // grid, cloud, state
  /// By kind: when its oldest undelivered message was accepted; NaN: all were delivered.
  std::array<double, 3> behind{kNever, kNever, kNever};
};

/// State that a process hands to the next: the sum of a journal's records.
class HandoverState {
 public:
  /// A pose that is queued (`news`), or in flight without an answer.
  struct Robot {
    queues::PostedPose posted;
    bool news = true, under_way = false;
  };

  /// False: the record is unknown and had no effect.
  bool apply(RecordKind kind, std::string_view said);

  /// Writes the same state as few records.
  void write(const std::function<void(RecordKind, std::string_view)>& to) const;

  /// Sets the present boot. Drops monotonic times of another boot, and stamps derived from them.
  void set_boot(const std::string& boot);

  /// std::nullopt: the first process of this boot.
  const std::optional<Clock>& clock() const { return clock_; }
  const queues::StampShift& senders() const { return senders_; }
  const std::map<icd::Uri, pace::LearnedRate>& paces() const { return paces_; }
  const std::map<icd::Uri, icd::Stamp>& stamps() const { return stamps_; }
  /// queues::Canvases::PostedAreas. std::nullopt: not recorded.
  const std::optional<std::map<std::string, queues::Extent>>& grids() const { return grids_; }
  /// Robots with an undelivered pose. Delivered ones are dropped, because the Command Post may change.
  const std::map<icd::RobotName, Robot>& robots() const { return robots_; }
  /// By robot. Empty after a boot.
  const std::map<std::string, Heard>& heard_by_robot() const { return heard_; }
  /// Heard::behind of a robot and kind; NaN also for an unknown robot.
  double lag(const std::string& robot, std::size_t kind) const;
  /// Markers that are not delivered, in order.
  icd::MarkersUpdate markers() const;

 private:
  bool read_clock(std::string_view said);
  bool read_senders(std::string_view said);
  bool read_poses(std::string_view said);
  bool read_state_sent(std::string_view said);
  bool read_markers(std::string_view said);
  bool read_sent(std::string_view said);
  bool read_heard(std::string_view said);
  void on_state_done();
  void put_back_state();
  void put_back_markers();

  std::optional<Clock> clock_;
  queues::StampShift senders_;
  std::map<icd::Uri, pace::LearnedRate> paces_;
  std::map<icd::Uri, icd::Stamp> stamps_;
  std::optional<std::map<std::string, queues::Extent>> grids_;
  std::map<icd::RobotName, Robot> robots_;
  std::map<std::string, Heard> heard_;
  queues::MarkerChanges markers_;
  std::vector<icd::Marker> markers_under_way_;
};

/// The sum of the records, and a sentence about damage, or "". After a gap no message counts as delivered,
/// because the message that was delivered may be in the gap. Unknown records are logged.
std::pair<HandoverState, std::string> read_records(const store::Contents& contents);

/// What the records of RecordKind::Markers say for an accepted message: at least one record, each of about a
/// megabyte at most or of one marker. Any thread may make them.
std::vector<std::string> records_of(std::span<const icd::Marker> markers);

/// What a record of RecordKind::MarkersSent says: ns, id and action of each marker.
std::string names_of(std::span<const icd::Marker> markers);

}  // namespace adit::journal

// The structs in records. All other records are store::bytes_of() what HandoverState reads them as.
namespace adit {

template <>
inline constexpr auto store::kMembers<journal::Clock> =
    std::tuple(&journal::Clock::boot, &journal::Clock::at, &journal::Clock::stamp, &journal::Clock::step_to,
               &journal::Clock::step_by, &journal::Clock::off, &journal::Clock::off_since);
template <>
inline constexpr auto store::kMembers<journal::Heard> =
    std::tuple(&journal::Heard::robot, &journal::Heard::messages, &journal::Heard::gap, &journal::Heard::last,
               &journal::Heard::kinds, &journal::Heard::behind);
template <>
inline constexpr auto store::kMembers<journal::Heard::Times> =
    std::tuple(&journal::Heard::Times::accepted, &journal::Heard::Times::forwarded);
template <>
inline constexpr auto store::kMembers<queues::Stamper> =
    std::tuple(&queues::Stamper::address, &queues::Stamper::uri, &queues::Stamper::robot);
template <>
inline constexpr auto store::kMembers<queues::SenderClock> =
    std::tuple(&queues::SenderClock::theirs, &queues::SenderClock::ours, &queues::SenderClock::latest);
template <>
inline constexpr auto store::kMembers<queues::Extent> =
    std::tuple(&queues::Extent::left, &queues::Extent::bottom, &queues::Extent::right, &queues::Extent::top);
template <>
inline constexpr auto store::kMembers<pace::LearnedRate> =
    std::tuple(&pace::LearnedRate::earliest, &pace::LearnedRate::spacing, &pace::LearnedRate::under_way,
               &pace::LearnedRate::from_answers, &pace::LearnedRate::single);
template <>
inline constexpr auto store::kMembers<pace::Span> = std::tuple(&pace::Span::first, &pace::Span::last);
template <>
inline constexpr auto store::kMembers<icd::RobotName> = std::tuple(&icd::RobotName::text);
template <>
inline constexpr auto store::kMembers<queues::PostedPose> =
    std::tuple(&queues::PostedPose::name, &queues::PostedPose::address, &queues::PostedPose::stamp,
               &queues::PostedPose::pose);
template <>
inline constexpr auto store::kMembers<icd::Pose> = std::tuple(&icd::Pose::position, &icd::Pose::orientation);
template <>
inline constexpr auto store::kMembers<icd::Point> =
    std::tuple(&icd::Point::x, &icd::Point::y, &icd::Point::z);
template <>
inline constexpr auto store::kMembers<icd::Quaternion> =
    std::tuple(&icd::Quaternion::x, &icd::Quaternion::y, &icd::Quaternion::z, &icd::Quaternion::w);
template <>
inline constexpr auto store::kMembers<icd::Color> =
    std::tuple(&icd::Color::r, &icd::Color::g, &icd::Color::b, &icd::Color::a);
template <>
inline constexpr auto store::kMembers<icd::Header> = std::tuple(&icd::Header::stamp);
template <>
inline constexpr auto store::kMembers<icd::Marker> = std::tuple(
    &icd::Marker::header, &icd::Marker::ns, &icd::Marker::id, &icd::Marker::type, &icd::Marker::action,
    &icd::Marker::pose, &icd::Marker::scale, &icd::Marker::color, &icd::Marker::lifetime, &icd::Marker::text,
    &icd::Marker::frame_locked, &icd::Marker::points, &icd::Marker::colors, &icd::Marker::mesh_resource,
    &icd::Marker::mesh_use_embedded_materials, &icd::Marker::expires);
/// What tells a robot's pose from others.
template <>
inline constexpr auto store::kMembers<icd::NamedPose> = std::tuple(&icd::NamedPose::name);
template <>
inline constexpr std::size_t store::kMemberCount<icd::NamedPose> = 1;

}  // namespace adit

namespace adit::journal {

/// Data that must survive a crash of the service, not of the machine: accepted telemetry that is not
/// delivered, the last request to each URI, used stamps, and senders' clocks (README.md).
///
/// Each record is one write by the loop to a log in memory (store/README.md); the next process finds it once
/// the call has returned. If there is no room for a record that no client's answer depends on, the record is
/// kept in this process and written before the next one. Until then the journal rejects all other records.
class Journal {
 public:
  /// Storage of the log.
  static constexpr store::LogOptions kKeeping{store::kInMemory, 0, false};
  /// Most bytes of unwritten records; more are lost.
  static constexpr std::size_t kMostUnsaid = 8u << 20;
  /// Least size for a snapshot, which is made when the file exceeds this and the last snapshot.
  static constexpr std::size_t kLeastTurn = 1u << 20;

  Journal(loop::Loop& loop, std::string folder);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Records of earlier processes. If a file cannot be read, the files stay, the result is empty, and
  /// append() fails until the next start.
  HandoverState read();
  /// Why a file of earlier processes cannot be read, or "".
  const std::string& unread() const { return unread_; }
  /// Whether all files of a journal's directory, if it exists, can be read now.
  static bool can_be_read(const std::string& folder);
  /// A sentence about damaged records of earlier processes, or "".
  const std::string& damage() const { return damage_; }
  /// Call once, after read() and before any other member.
  void begin(const Clock& clock);
  /// Records a change of the clock.
  void clock(const Clock& clock) { note(RecordKind::Clock, store::bytes_of(clock)); }

  /// Error: not stored; the client must not get a success.
  using Kept = std::expected<void, std::string>;
  Kept record_accepted(std::span<const queues::PostedPose> poses) {
    return append(RecordKind::Poses, store::bytes_of(poses));
  }
  Kept record_accepted(const icd::MarkersUpdate& update);
  /// `record`: one of records_of() a message. If a later one fails, the next process sends the markers of the
  /// earlier ones although the client was refused; the client's next try replaces them.
  Kept accepted_markers(const std::string& record) { return append(RecordKind::Markers, record); }

  void record_senders(const queues::StampShift::Clocks& clocks);
  /// For the next process. A failed record is dropped, because the next one replaces it.
  void record_heard(const Heard& heard) { (void)append(RecordKind::Heard, store::bytes_of(heard)); }

  /// Call before these poses or markers are sent.
  void record_state_sent(const icd::StateUpdate& update) {
    note(RecordKind::StateSent, store::bytes_of(update.poses));
  }
  void record_markers_sent(const icd::MarkersUpdate& update) {
    note(RecordKind::MarkersSent, names_of(update.markers));
  }
  /// `done`: delivered or rejected; otherwise queued again.
  void record_state_answered(bool done);
  void record_markers_answered(bool done);

  void record_pace(icd::Uri uri, const pace::LearnedRate& learned) {
    note(RecordKind::Pace, store::bytes_of(uri, learned));
  }
  void record_stamp(icd::Uri uri, icd::Stamp stamp) { note(RecordKind::Stamp, store::bytes_of(uri, stamp)); }
  /// Starts the record of posted grids; record_grid() does so too.
  Kept begin_grids() { return append(RecordKind::Grids, {}); }
  Kept record_grid(const std::string& name, const queues::Extent& extent) {
    return append(RecordKind::Grids, store::bytes_of(name, extent));
  }

  /// Why the last record could not be stored, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  struct PendingRecord {
    RecordKind kind;
    std::string said;
  };
  Kept open();
  void note(RecordKind kind, std::string said);
  /// Records that sent data is queued again, or removes the record of the sending if it is still unwritten.
  void record_return(RecordKind sent, RecordKind back);
  Kept append(RecordKind kind, std::string_view said);
  Kept append_pending();
  Kept write(RecordKind kind, std::string_view said);
  void compact();
  void on_compaction_failed(const store::Error& error);
  Kept on_failed(const std::string& why);

  const std::string path_;
  std::optional<store::Directory> directory_;
  std::optional<store::Contents> contents_;  // of earlier processes, until begin()
  std::optional<store::Log> log_;
  std::string unread_;  // why a file of earlier processes could not be read
  std::string damage_;
  std::vector<PendingRecord> unsaid_;  // in order
  std::size_t unsaid_size_ = 0;
  std::size_t size_ = 0, snapshot_ = 0;  // bytes of the file, and of the last snapshot
  std::size_t least_ = kLeastTurn;
  bool compacting_ = false;
  std::string trouble_;
  std::atomic<bool> ending_ = false;
  loop::Workers compactor_;  // its own thread, because a snapshot may take a second
};

}  // namespace adit::journal
