#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
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

  /// The Command Post took these, at `now`; the first is at number 1, later ones never run backward.
  void forwarded(const icd::MarkersUpdate& update, api::Time now);
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
  using InOrder = std::map<std::uint64_t, Key>;

  void begin_change(api::Time now);
  void apply(const icd::Marker& marker, api::Time now);
  void remove(const Key& key);
  void clear();
  void keep_bounds();
  void put(const Key& key, Entry entry);
  void erase(const Key& key);

  std::map<Key, Entry> entries_;  // those that are gone too, as long as there is room
  struct Held {
    InOrder in_order;  // by version
    std::size_t bytes = 0;
  } standing_, gone_;
  std::uint64_t version_ = 0, forgotten_ = 0;  // all that went up to this version is not told any more
  std::uint64_t left_out_ = 0;
};

}  // namespace adit::forward
