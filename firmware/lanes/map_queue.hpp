#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "lanes/canvases.hpp"
#include "lanes/successive.hpp"
#include "lanes/waiting_map.hpp"

namespace adit::lanes {

/// The maps of one sender that wait, in the order in which they were made: see MapLane, which says what its
/// functions do.
class MapQueue {
 public:
  /// A grid lets later ones of its name pass after so many failures.
  static constexpr int kInPlace = 3;

  std::vector<std::uint64_t> add(WaitingMap added);
  void append(WaitingMap added);  // replaces none
  /// Whether one may go now: none does that rests, nor a grid behind one that rests.
  bool is_ready(Instant now) const;
  /// Since when one rests and how old it is, of the one that rested longest. Requires a map.
  std::pair<Instant, Instant> resting() const;
  /// The oldest news of those that may go; if none may, what rested longest. Requires a map.
  WaitingMap take(Instant now, std::size_t merge_bytes, Canvases& canvases);
  std::vector<std::uint64_t> put_back(WaitingMap map);
  void put_back_apart(WaitingMap map);
  void step_forward();  // nothing steps behind any more

  /// Takes the older of the two out, where both still wait as they were, for the newer one has all its
  /// points.
  std::vector<std::uint64_t> replace(const Successive& two);
  /// The last two clouds, where it is not known yet whether the newer one has all points of the older one.
  std::optional<Successive> to_compare() const;
  void keep_both(const Successive& two);  // it is now

  bool replaces_any(const WaitingMap& map) const;
  bool is_replaced(const WaitingMap& map) const;
  bool joins(const WaitingMap& map) const;
  /// When the oldest news was accepted; nothing if none waits.
  std::optional<Instant> oldest() const;
  std::size_t count() const { return waiting_.size(); }
  std::size_t bytes() const { return bytes_; }
  std::size_t largest_replaceable() const;

 private:
  using Maps = std::deque<WaitingMap>;
  Maps::const_iterator ready(Instant now) const;
  Maps::const_iterator rested_longest() const;
  Maps::const_iterator before_newer(const WaitingMap& back) const;
  /// Each adds to `leaves`, in the order of waiting_, what goes with the next.
  void merge_followers(WaitingMap& next, std::size_t merge_bytes, std::vector<bool>& leaves) const;
  void stitch_followers(WaitingMap& next, std::size_t place, const Canvas* canvas,
                        std::vector<bool>& leaves) const;
  void insert(Maps::const_iterator place, std::vector<WaitingMap> parts);
  std::vector<std::size_t> that_follow(std::size_t place) const;

  Maps waiting_;
  std::size_t bytes_ = 0;
};

}  // namespace adit::lanes
