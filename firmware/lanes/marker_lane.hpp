#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "icd/markers_update.hpp"
#include "lanes/map_lane.hpp"
#include "lanes/marker_changes.hpp"

namespace adit::lanes {

/// The pending changes of the markers' scene (ICD 6.6), as few as say the same: `pending` followed by
/// `newer`, where a newer change of the same ns and id takes the place of an older one, DeleteAll takes the
/// place of all before it, and nothing is deleted that a DeleteAll before it has deleted. Law: replaying the
/// result on any scene gives what replaying both in order gives.
std::vector<icd::Marker> merge(const std::vector<icd::Marker>& pending,
                               const std::vector<icd::Marker>& newer);

struct WaitingMarkers {
  icd::MarkersUpdate update;
  Instant accepted;                    // when the oldest news in it was accepted
  std::vector<std::uint64_t> updates;  // those of which it is the last message, oldest first
};

/// The changes of markers that wait for the Command Post, oldest first.
class MarkerLane {
 public:
  /// What a lane holds at most, so that no sender can fill the memory while the Command Post is away.
  static constexpr std::size_t kMostMarkers = 100'000, kMostUpdates = 100'000;

  /// At most `most` markers go into one message; at least 1.
  explicit MarkerLane(std::size_t most) : most_(most) {}

  bool has_room_for(const icd::MarkersUpdate& update) const {
    return update.markers.size() <= kMostMarkers - std::min(kMostMarkers, count()) &&
           updates_.size() < kMostUpdates;
  }
  void add(std::uint64_t number, const icd::MarkersUpdate& update, Instant now);
  /// The oldest pending changes, in order. Updates' numbers go with the message that sends the last of their
  /// markers.
  std::optional<WaitingMarkers> take();
  /// What take() gave last and could not be sent goes before what came meanwhile, merged with it.
  void put_back(const WaitingMarkers& markers);

  std::size_t count() const { return changes_.count(); }  // of markers
  /// All that wait, in order.
  std::vector<icd::Marker> pending() const;
  std::optional<Instant> oldest() const;
  bool empty() const { return updates_.empty(); }

 private:
  static constexpr auto kNowhere = std::numeric_limits<MarkerChanges::Place>::min();

  struct Update {
    std::uint64_t number = 0;
    Instant accepted;
    MarkerChanges::Place last = kNowhere;  // of its changes; it is done when all up to there have been taken
  };

  std::size_t most_;
  MarkerChanges changes_;
  std::vector<Update> updates_;
};

}  // namespace adit::lanes
