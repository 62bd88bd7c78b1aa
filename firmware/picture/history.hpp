#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "picture/tile.hpp"

namespace adit::picture {

/// A tile as it was from `stamp` on.
struct Version {
  double stamp = 0;          // seconds since 1970
  std::uint64_t number = 0;  // Mosaic::version() of when it came
  Tile tile;
};

/// What a version costs in memory, nearly.
std::size_t cost_of(const Version& version);

/// One tile over time.
///
/// Time is cut into spans of `spacing` seconds, and of each span only the last version is kept: as of any
/// time, what is shown is at most `spacing` old. Spans twice as long are two of these, so that thinning at
/// last is as if it had been so from the start.
class History {
 public:
  /// Requires a stamp that is not before the newest.
  void add(Version version, double spacing);
  void thin(double spacing);
  /// The time of day was set ahead by so many seconds.
  void move(double seconds) {
    for (Version& version : versions_) version.stamp += seconds;
  }
  /// The newest state is from now on that of this version.
  void renumber(std::uint64_t number) { versions_.back().number = number; }

  /// As of that time; null where there was nothing yet.
  const Version* at(double stamp) const;
  /// When that state of it was followed by another; nothing: it is the newest.
  std::optional<double> end_of(const Version& version) const;
  const Version& first() const { return versions_.front(); }
  const Version& newest() const { return versions_.back(); }
  bool empty() const { return versions_.empty(); }
  std::size_t cost() const { return cost_; }

 private:
  std::vector<Version> versions_;  // oldest first
  std::size_t cost_ = 0;
};

}  // namespace adit::picture
