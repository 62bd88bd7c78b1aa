#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/run_view.hpp"
#include "api/scene.hpp"
#include "icd/mapping.hpp"

namespace adit::forward {

/// Positions that the Command Post has of the run: one a second in motion, one per kStill at rest. A full
/// track halves its poses and its rate.
class Tracks {
 public:
  static constexpr std::size_t kMostPoses = 4000;     // per robot: over an hour
  static constexpr double kSpacing = 1, kStill = 10;  // seconds

  /// Callers bound the number of robots.
  void on_forwarded(const std::string& robot, const api::TrackPose& pose);
  /// Adds earlier poses before the present ones.
  void restore(const std::vector<api::Track>& earlier);
  void wipe() { tracks_.clear(); }
  /// The time of day was set ahead by `seconds`.
  void move(double seconds);
  void forget(const std::string& robot) { tracks_.erase(robot); }

  /// By name: poses later than `since`. Robots without such poses are left out.
  std::vector<api::Track> tracks_after(api::Time since) const;

 private:
  struct StoredTrack {
    std::vector<api::TrackPose> poses;
    double spacing = kSpacing;
  };
  std::map<std::string, StoredTrack> tracks_;
};

/// The Command Post's markers by ns and id, as drawn on a map, with changes by version. Beyond kMost or
/// kMostBytes the oldest are left out and counted.
class MarkerScene {
 public:
  static constexpr std::size_t kMost = 2000;
  static constexpr std::size_t kMostBytes = 1'000'000;  // as in DrawnMarker::size()

  MarkerScene() = default;
  MarkerScene(MarkerScene&&) = default;  // a copy would refer to the original
  MarkerScene& operator=(MarkerScene&&) = default;
  ~MarkerScene() = default;

  /// Each marker gets a higher version.
  void on_forwarded(std::span<const icd::Marker> markers, api::Time now);
  /// The time of day was set ahead by `seconds`.
  void move(double seconds) {
    for (auto& [key, entry] : entries_) entry.at += seconds;
  }
  /// Clears all markers for a new run.
  void wipe(api::Time now);

  std::uint64_t version() const { return version_; }
  /// All markers if `since` is too old.
  api::MarkerChanges changes(std::uint64_t since) const;

 private:
  using Key = std::pair<std::string, std::int32_t>;
  struct Entry {
    api::DrawnMarker marker;
    api::Time at = 0;
    std::uint64_t version = 0;
    bool gone = false;  // only the ns remains
  };
  /// By the id first, which differs most.
  struct KeyLess {
    bool operator()(const Key& a, const Key& b) const {
      return a.second != b.second ? a.second < b.second : a.first < b.first;
    }
  };
  using Entries = std::map<Key, Entry, KeyLess>;
  using InOrder = std::map<std::uint64_t, Entries::iterator>;
  struct EntryList {
    InOrder in_order;  // by version
    std::size_t bytes = 0;
  };

  void begin_change(api::Time now);
  void apply(const icd::Marker& marker, api::Time now);
  void remove(Entries::iterator at);
  void clear();
  void keep_bounds();
  void put(Entries::iterator at, Entry entry);
  void release(const Entry& entry);
  EntryList& list_of(const Entry& entry) { return entry.gone ? gone_ : standing_; }

  Entries entries_;  // with deleted ones
  EntryList standing_, gone_;
  std::uint64_t version_ = 0, forgotten_ = 0;  // forgotten_: last deletion not kept
  std::uint64_t left_out_ = 0;
};

/// Robots and markers as the Command Post has them, without queued messages.
class DeliveredScene {
 public:
  static constexpr std::size_t kMostRobots = 100;  // the latest ones

  /// Poses that robots posted, not ones that a state repeats.
  void on_forwarded(std::span<const icd::NamedPose> poses, api::Time now);
  void on_forwarded(std::span<const icd::Marker> markers, api::Time now) {
    markers_.on_forwarded(markers, now);
  }
  /// Robots keep their positions.
  void begin_run(api::Time now);

  /// The time of day was set ahead by `seconds`: adjusts all times.
  void move(double seconds);

  /// Restores the tracks of this run from before a restart.
  void restore(std::vector<api::Track> earlier);

  /// Last poses, by name.
  std::vector<facts::RobotRow> robots() const;
  /// Last pose of each robot in this run before a restart.
  const std::map<std::string, api::Time>& earlier_poses() const { return before_; }
  const MarkerScene& markers() const { return markers_; }
  const Tracks& tracks() const { return tracks_; }

 private:
  void forget_oldest();

  std::map<std::string, facts::RobotRow> robots_;
  std::map<std::string, api::Time> before_;
  MarkerScene markers_;
  Tracks tracks_;
};

}  // namespace adit::forward
