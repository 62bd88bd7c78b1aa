#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/box.hpp"
#include "api/run_view.hpp"
#include "icd/header.hpp"
#include "icd/status.hpp"
#include "icd/uri.hpp"
#include "intake/desk.hpp"
#include "lanes/clouds.hpp"
#include "lanes/precision.hpp"
#include "loop/loop.hpp"

namespace adit::forward {

enum class Kind : std::uint8_t { Grid, Cloud, State, Markers };

/// Why a message was not taken upstream: sent too often, failed (both are sent again), or refused for good.
enum class NotTaken : std::uint8_t { Throttled, Failed, Refused };

/// The kinds whose times outlive a restart, by their names in the API; the first ones of Kind.
inline constexpr std::string_view kHeardKinds[] = {"grid", "cloud", "state"};

/// The time of day of a stamp by the clock for stamps; now, if the stamp is ahead of that. NaN of NaN.
inline api::Time time_of(const loop::Loop& loop, icd::Stamp stamp) {
  return loop.wall_now() - std::max(loop.stamp_now() - stamp, 0.0);
}

/// The robot and the kind of its messages: "" is a merged map, or markers.
struct Traffic {
  Kind kind = Kind::Grid;
  std::string robot;
  friend auto operator<=>(const Traffic&, const Traffic&) = default;
};

inline bool is_map(Kind kind) {
  return kind == Kind::Grid || kind == Kind::Cloud;
}

/// What happened to the team's messages, counted and kept for the page: how many were accepted, forwarded,
/// replaced, delayed, refused, and why (promise 7). Holds at most kMostRows rows and kMostRefusals refusals.
class Record {
 public:
  static constexpr std::size_t kMostRows = 200;
  static constexpr std::size_t kMostRefusals = 50;

  /// `changed` is called whenever something is noted.
  explicit Record(std::function<void()> changed) : changed_(std::move(changed)) {}

  void accepted(const Traffic& traffic, std::size_t bytes, api::Time now);
  /// Restores when the last message was accepted, and delivered (NaN: never), before a restart. Call after
  /// accepted() for queued messages, which may be newer.
  void restore(const Traffic& traffic, api::Time accepted, api::Time forwarded);
  /// It was refused to the robot, because too much waits.
  void no_room(const Traffic& traffic, api::Time now);
  void replaced(const Traffic& traffic, std::size_t updates);
  /// So many points of its clouds were not sent, for others of their voxels had been taken.
  void left_out(const Traffic& traffic, std::size_t points);
  /// A cloud was accepted that has no valid point, so that nothing of it is sent.
  void no_valid_point(const Traffic& traffic, std::size_t bytes, api::Time now);
  /// So many markers were accepted that nobody will see.
  void invisible(std::size_t markers);
  /// What its clouds were taken for.
  void clouds_are(const Traffic& traffic, lanes::Clouds clouds);
  /// How far the cloud was rounded that the Command Post took last.
  void rounded_to(const Traffic& traffic, lanes::Precision precision);
  /// The Command Post took a message of `bytes` that stands for `updates` accepted ones.
  void forwarded(const Traffic& traffic, std::size_t updates, std::size_t bytes, int status, api::Time now);
  /// The Command Post did not take it; 0: no status came.
  void not_taken(const Traffic& traffic, NotTaken how, int status, const std::string& sentence);

  void refused(icd::Uri uri, const intake::Sender& sender, const icd::Refusal& refusal, api::Time now);

  /// The time of day was set ahead by so many seconds: what is noted is as long ago as it was.
  void move(double seconds);

  /// Without `waiting` and `behind_since`, which the lanes know.
  const std::map<Traffic, api::ActivityRow>& rows() const { return rows_; }
  /// What was ever refused, by URI and status.
  std::vector<api::RefusedCount> refused_counts() const;
  /// Newest first.
  std::vector<api::RefusalRow> refusals() const { return {refusals_.begin(), refusals_.end()}; }
  void changed() const { changed_(); }

 private:
  api::ActivityRow& row(const Traffic& traffic);

  std::function<void()> changed_;
  std::map<Traffic, api::ActivityRow> rows_;
  std::deque<api::RefusalRow> refusals_;
  std::map<std::pair<icd::Uri, icd::Status>, api::RefusedCount> refused_;  // its counts
};

Traffic traffic_of(const icd::MapUpdate& update);

}  // namespace adit::forward
