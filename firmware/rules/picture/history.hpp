#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "picture/tile.hpp"

namespace adit::picture {

/// The state of a tile from `stamp` on.
struct Version {
  double stamp = 0;          // seconds since 1970
  std::uint64_t number = 0;  // Mosaic::version() of this change
  Tile tile;
};

/// Approximate memory of a version.
std::size_t cost_of(const Version& version);

/// One tile over time.
///
/// Time is divided into spans of `spacing` seconds. Only the last version of each span is kept, so the
/// version shown for any time is at most `spacing` old. A span of twice the length covers two of these, so
/// repeated thinning gives the same result as the final spacing from the start.
class History {
 public:
  /// Requires a stamp that is not before the newest.
  void add(Version version, double spacing);
  void thin(double spacing);
  /// Shifts all stamps: the time of day was set ahead by `seconds`.
  void move(double seconds) {
    for (Version& version : versions_) version.stamp += seconds;
  }
  /// Gives the newest version this number.
  void renumber(std::uint64_t number) { versions_.back().number = number; }

  /// The version at that time, or null if there was none yet.
  const Version* at(double stamp) const;
  /// When another version followed; nullopt: it is the newest.
  std::optional<double> end_of(const Version& version) const;
  const Version& first() const { return versions_.front(); }
  const Version& newest() const { return versions_.back(); }
  const std::vector<Version>& versions() const { return versions_; }  // oldest first
  bool empty() const { return versions_.empty(); }
  std::size_t cost() const { return cost_; }

 private:
  std::vector<Version> versions_;  // oldest first
  std::size_t cost_ = 0;
};

}  // namespace adit::picture
