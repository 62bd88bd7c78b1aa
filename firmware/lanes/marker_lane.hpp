#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "icd/markers_update.hpp"
#include "lanes/map_lane.hpp"

namespace adit::lanes {

/// The pending changes of the markers' scene (ICD 6.6), as few as say the same: `pending` followed by
/// `newer`, where a newer change of the same ns and id takes the place of an older one and DeleteAll takes
/// the place of all before it. Law: replaying the result on any scene gives what replaying both in order
/// gives.
std::vector<icd::Marker> merge(std::vector<icd::Marker> pending, const std::vector<icd::Marker>& newer);

struct WaitingMarkers {
  icd::MarkersUpdate update;
  Instant accepted;
  std::vector<std::uint64_t> updates;
};

class MarkerLane {
 public:
  /// At most `most` markers go into one message.
  explicit MarkerLane(std::size_t most) : most_(most) {}

  void add(std::uint64_t number, const icd::MarkersUpdate& update, Instant now);
  /// The oldest pending changes, in order. Updates' numbers go with the message that sends the last of their
  /// markers.
  std::optional<WaitingMarkers> take();
  /// What could not be sent goes before what came meanwhile, merged with it.
  void put_back(WaitingMarkers markers);

  std::size_t count() const { return pending_.size(); }
  std::optional<Instant> oldest() const { return oldest_; }
  bool empty() const { return pending_.empty(); }

 private:
  std::size_t most_;
  std::vector<icd::Marker> pending_;
  std::optional<Instant> oldest_;
  std::vector<std::uint64_t> updates_;
};

}  // namespace adit::lanes
