#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "api/scene.hpp"
#include "icd/markers_update.hpp"

namespace adit::forward {

/// The markers as the Command Post was last told of them, by ns and id, as a map draws them, and which of
/// them changed after a version. At most kMost, and kMostBytes of them; if there are more, those forwarded
/// longest ago are left out and counted.
class MarkerScene {
 public:
  static constexpr std::size_t kMost = 2000;
  static constexpr std::size_t kMostBytes = 1'000'000;  // as DrawnMarker::size() has it

  MarkerScene() = default;
  MarkerScene(MarkerScene&&) = default;  // a copy's order would be of the other's markers
  MarkerScene& operator=(MarkerScene&&) = default;
  ~MarkerScene() = default;

  /// The Command Post took these, at `now`; the first is at number 1, later ones never run backward.
  void forwarded(std::span<const icd::Marker> markers, api::Time now);
  /// The time of day was set ahead by so many seconds.
  void move(double seconds) {
    for (auto& [key, entry] : entries_) entry.at += seconds;
  }
  /// A new run begins with none.
  void wipe(api::Time now);

  std::uint64_t version() const { return version_; }
  /// What changed after `since`; all markers if that is no longer known.
  api::MarkerChanges changes(std::uint64_t since) const;

 private:
  using Key = std::pair<std::string, std::int32_t>;
  struct Entry {
    api::DrawnMarker marker;
    api::Time at = 0;
    std::uint64_t version = 0;
    bool gone = false;  // of the marker only the ns is left, which counts
  };
  /// By the id first, which alone tells most of them apart.
  struct ByKey {
    bool operator()(const Key& a, const Key& b) const {
      return a.second != b.second ? a.second < b.second : a.first < b.first;
    }
  };
  using Entries = std::map<Key, Entry, ByKey>;
  using InOrder = std::map<std::uint64_t, Entries::iterator>;
  struct Held {
    InOrder in_order;  // by version
    std::size_t bytes = 0;
  };

  void begin_change(api::Time now);
  void apply(const icd::Marker& marker, api::Time now);
  void remove(Entries::iterator at);
  void clear();
  void keep_bounds();
  void put(Entries::iterator at, Entry entry);
  void let_go(const Entry& entry);
  Held& held_with(const Entry& entry) { return entry.gone ? gone_ : standing_; }

  Entries entries_;  // those that are gone too, as long as there is room
  Held standing_, gone_;
  std::uint64_t version_ = 0, forgotten_ = 0;  // all that went up to this version is not told any more
  std::uint64_t left_out_ = 0;
};

}  // namespace adit::forward
