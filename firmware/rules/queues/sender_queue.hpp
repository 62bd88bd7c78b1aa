#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "icd/map_update.hpp"
#include "queues/canvases.hpp"
#include "queues/queued_map.hpp"
#include "queues/sender.hpp"

namespace adit::queues {

/// Two successive queued clouds of one sender with the same fields, byte order and origin.
struct Successive {
  Sender sender;
  std::vector<std::uint64_t> older_updates, newer_updates;  // QueuedMap::updates, to find them again
  icd::MapData older, newer;                                // not compressed
  std::uint32_t point_step = 0;                             // bytes
};

/// The queued maps of one sender, in the order in which they were made. MapQueue describes the functions.
class SenderQueue {
 public:
  /// After so many failures of a grid, later grids of its name go ahead of it.
  static constexpr int kInPlace = 3;

  Replaced add(QueuedMap added);
  void append(QueuedMap added);  // replaces no map
  /// Whether a map may be sent now. A map that rests may not, nor a grid behind a grid that rests.
  bool is_ready(Instant now) const;
  /// Orders resting maps: whether it goes last, when it failed, and when it was accepted.
  using Rest = std::tuple<bool, Instant, Instant>;
  /// Of the map that has rested longest. Requires a map.
  Rest resting() const;
  /// The oldest map that may be sent. If there is none, the map that has rested longest. Requires a map.
  QueuedMap take(Instant now, std::size_t merge_bytes, Canvases& canvases);
  Replaced put_back(QueuedMap map);
  void put_back_apart(QueuedMap map);
  void put_back_halves(QueuedMap map);
  void restart_pieces();
  void inherit(const Trial& trial);  // by the maps that have not failed themselves
  void step_forward();               // clears Trial::steps_behind of all maps

  std::vector<std::uint64_t> replace(const Successive& two);
  /// The last two clouds, if they have not been compared yet.
  std::optional<Successive> to_compare() const;
  void keep_both(const Successive& two);

  bool replaces_any(const QueuedMap& map) const;
  std::optional<Replaced> absorb(const QueuedMap& map);
  bool joins(const QueuedMap& map) const;
  /// When the oldest queued map was accepted, or nothing.
  std::optional<Instant> oldest() const;
  std::size_t count() const { return waiting_.size(); }
  std::size_t bytes() const { return bytes_; }
  std::size_t largest_replaceable() const;

 private:
  using Maps = std::deque<QueuedMap>;
  Maps::const_iterator ready(Instant now) const;
  Maps::const_iterator rested_longest() const;
  Maps::const_iterator before_newer(const QueuedMap& back) const;
  /// Each marks in `leaves`, which has the order of waiting_, the maps that go with `next`.
  void merge_followers(QueuedMap& next, std::size_t merge_bytes, std::vector<bool>& leaves) const;
  void stitch_followers(QueuedMap& next, std::size_t place, const Canvas* canvas,
                        std::vector<bool>& leaves) const;
  void insert(Maps::const_iterator place, std::vector<QueuedMap> parts);
  std::vector<std::size_t> that_follow(std::size_t place) const;

  Maps waiting_;
  std::size_t bytes_ = 0;
};

}  // namespace adit::queues
