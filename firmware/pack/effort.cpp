#include "pack/effort.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "codec/gzip_whole.hpp"

namespace adit::pack {
namespace {

/// So much of the time another effort has to save.
constexpr double kWorthIt = 0.9;

double seconds_per_byte(Effort effort) {
  return kSecondsPerByte[static_cast<std::size_t>(effort)];
}

/// The bytes from `at` on, `size` of them.
void append(std::vector<std::uint8_t>& to, const icd::ChunkedBytes& bytes, std::size_t at, std::size_t size) {
  for (const auto& chunk : bytes.chunks()) {
    const std::size_t before = std::min(at, chunk->size());
    const auto some = chunk->subspan(before, std::min(size, chunk->size() - before));
    to.insert(to.end(), some.begin(), some.end());
    at -= before;
    size -= some.size();
    if (size == 0) return;
  }
}

/// What Quick makes of a byte, by some stretches of the points.
double tried(const icd::ChunkedBytes& points) {
  constexpr std::size_t kShare = 32, kTelling = std::size_t{64} << 10, kStretches = 16;
  const std::size_t size = std::min(points.size(), std::max(points.size() / kShare, kTelling));
  std::vector<std::uint8_t> some;
  some.reserve(size);
  for (std::size_t i = 0; i < kStretches; ++i) {
    append(some, points, points.size() / kStretches * i, size / kStretches);
  }
  if (some.empty()) return 1;
  const auto member = codec::gzip_whole(some, codec::kFastestLevel, some.size());
  return member ? static_cast<double>(member->size()) / static_cast<double>(some.size()) : 1;
}

}  // namespace

Effort effort_for(std::size_t size, double quick_to, const Hurry& hurry) {
  struct Way {
    Effort effort;
    double leaves;  // seconds
    double takes(const Hurry& on, double bytes) const {
      return on.slowness * seconds_per_byte(effort) * bytes + leaves;
    }
  };
  const double bytes = static_cast<double>(size), as_it_came = bytes / hurry.bytes_per_second;
  const Way full{Effort::Full, as_it_came * quick_to * kFullOfQuick};
  double soonest = full.takes(hurry, bytes) * kWorthIt;
  Effort best = Effort::Full;
  for (const Way& way : {Way{Effort::Quick, as_it_came * quick_to}, Way{Effort::None, as_it_came}}) {
    const double takes = way.takes(hurry, bytes);
    if (way.leaves > hurry.longest || takes > soonest) continue;
    soonest = takes;
    best = way.effort;
  }
  return best;
}

/// Where none is best though nothing were left of it, there is nothing to try.
Effort effort_for(const icd::MapData& points, const Hurry& hurry) {
  const std::size_t size = points.bytes.size();
  if (effort_for(size, 0, hurry) == Effort::None) return Effort::None;
  return effort_for(size, tried(points.bytes), hurry);
}

double slowness(Effort effort, std::size_t size, double seconds) {
  const double expected = seconds_per_byte(effort) * static_cast<double>(size);
  return expected > 0 ? seconds / expected : 1;
}

}  // namespace adit::pack
