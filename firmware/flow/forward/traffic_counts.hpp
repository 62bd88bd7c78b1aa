#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/box.hpp"
#include "api/run_view.hpp"
#include "icd/mapping.hpp"
#include "icd/natural_order.hpp"
#include "icd/status.hpp"
#include "icd/uri.hpp"
#include "intake/message_handler.hpp"
#include "loop/loop.hpp"
#include "queues/clouds.hpp"

namespace adit::forward {

/// In the order of facts::kKinds.
enum class TrafficKind : std::uint8_t { Grid, Cloud, State, Markers };

/// Throttled and Failed messages are retried.
enum class DeliveryFailure : std::uint8_t { Throttled, Failed, Refused };

/// The kinds whose times survive a restart.
inline constexpr auto kHeardKinds = std::span(facts::kKinds).first<3>();

/// The time of day of a stamp, at most now. NaN for NaN.
inline api::Time time_of(const loop::Loop& loop, icd::Stamp stamp) {
  return loop.wall_now() - std::max(loop.stamp_now() - stamp, 0.0);
}

/// The instant of a stamp, at most now.
inline loop::Instant instant_of(const loop::Loop& loop, icd::Stamp stamp) {
  const std::chrono::duration<double> since(std::max(loop.stamp_now() - stamp, 0.0));
  return loop.now() - std::chrono::duration_cast<loop::Duration>(since);
}

/// A robot and a kind of message. `robot` "": merged maps, or markers.
struct Traffic {
  TrafficKind kind = TrafficKind::Grid;
  std::string robot;
  friend bool operator==(const Traffic&, const Traffic&) = default;
  friend bool operator<(const Traffic& one, const Traffic& other) {
    return one.kind != other.kind ? one.kind < other.kind : icd::NaturalOrder()(one.robot, other.robot);
  }
};

inline bool is_map(TrafficKind kind) {
  return kind == TrafficKind::Grid || kind == TrafficKind::Cloud;
}

/// Counts and reasons for the page: messages accepted, forwarded, replaced, delayed, refused (promise 7). At
/// most kMostRows and kMostRefusals.
class TrafficCounts {
 public:
  static constexpr std::size_t kMostRows = 200;
  static constexpr std::size_t kMostRefusals = 50;

  /// `changed`: the page's contents changed.
  explicit TrafficCounts(std::function<void()> changed) : changed_(std::move(changed)) {}

  void count_accepted(const Traffic& traffic, std::size_t bytes, api::Time now);
  /// Restores old times (NaN: never). Call after count_accepted() for queued messages, which may be newer.
  void restore(const Traffic& traffic, api::Time accepted, api::Time forwarded);
  /// A message was rejected because the queue is full.
  void no_room(const Traffic& traffic, api::Time now);
  void count_replaced(const Traffic& traffic, std::size_t updates) { row(traffic).replaced += updates; }
  /// A cloud without a valid point was accepted. It is not sent.
  void no_valid_point(const Traffic& traffic, std::size_t bytes, api::Time now);
  void count_invisible(std::size_t markers);
  /// The detected kind of a robot's clouds.
  void set_cloud_kind(const Traffic& traffic, queues::Clouds clouds);
  /// The rounding of the last delivered cloud.
  void rounded_to(const Traffic& traffic, queues::Precision precision);
  /// A message of `bytes` was delivered for `updates` accepted ones.
  void count_forwarded(const Traffic& traffic, std::size_t updates, std::size_t bytes, int status,
                       api::Time now);
  /// `status` 0: no status came.
  void count_undelivered(const Traffic& traffic, DeliveryFailure how, int status,
                         const std::string& sentence);

  void count_rejected(icd::Uri uri, const intake::Sender& sender, const icd::Refusal& refusal, api::Time now);

  /// The time of day was set ahead.
  void move(double seconds);

  /// The number of delivered messages of all kinds since the start.
  std::uint64_t delivered_count() const { return delivered_; }

  /// Rows without `queued` and `behind_since`, which the queues have.
  const std::map<Traffic, facts::ActivityRow>& rows() const { return rows_; }
  /// Counts of rejected messages by URI and status.
  std::vector<api::RefusedCount> refused_counts() const;
  /// Newest first.
  std::vector<facts::RefusalRow> refusals() const { return {refusals_.begin(), refusals_.end()}; }
  void notify_changed() const { changed_(); }

 private:
  facts::ActivityRow& row(const Traffic& traffic);

  std::function<void()> changed_;
  std::uint64_t delivered_ = 0;
  std::map<Traffic, facts::ActivityRow> rows_;
  std::deque<facts::RefusalRow> refusals_;
  std::map<std::pair<icd::Uri, icd::Status>, api::RefusedCount> refused_;  // counts only
};

Traffic traffic_of(const icd::MapUpdate& update);

}  // namespace adit::forward
