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
  void forwarded(std::span<const icd::Marker> markers, api::Time now);
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

  Entries entries_;  // with deleted ones
  Held standing_, gone_;
  std::uint64_t version_ = 0, forgotten_ = 0;  // forgotten_: last deletion not kept
  std::uint64_t left_out_ = 0;
};

}  // namespace adit::forward
