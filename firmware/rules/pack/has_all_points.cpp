#include "pack/has_all_points.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "pack/points.hpp"

namespace adit::pack {
namespace {

using Point = std::span<const std::uint8_t>;

/// Steele, Lea and Flood, "Fast splittable pseudorandom number generators" (2014): each bit affects all.
std::uint64_t mix_bits(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

std::uint64_t hash_of(Point point) {
  std::uint64_t hash = 0x9e3779b97f4a7c15u, word = 0;
  for (; point.size() >= sizeof word; point = point.subspan(sizeof word)) {
    std::memcpy(&word, point.data(), sizeof word);
    hash = mix_bits(hash ^ word);
  }
  word = 0;
  if (!point.empty()) std::memcpy(&word, point.data(), point.size());
  return mix_bits(hash ^ word);
}

/// A set of point hashes to find: open addressing, at most half full.
class PointSet {
 public:
  explicit PointSet(std::size_t most) : places_(std::bit_ceil(2 * most + 2)) {}

  void add(Point point) {
    std::uint64_t& place = place_of(point);
    if (place == 0) ++missing_;
    place = key_of(hash_of(point));
  }
  void on_found(Point point) {
    std::uint64_t& place = place_of(point);
    if (place == 0 || (place & kFound) != 0) return;
    place |= kFound;
    --missing_;
  }
  std::size_t missing() const { return missing_; }

 private:
  static constexpr std::uint64_t kFound = 1, kTaken = 2;
  static std::uint64_t key_of(std::uint64_t hash) { return (hash & ~kFound) | kTaken; }

  /// The place of the point, or the free place for it.
  std::uint64_t& place_of(Point point) {
    const std::uint64_t hash = hash_of(point);
    std::size_t at = hash >> 2;
    while (true) {
      std::uint64_t& place = places_[at++ & (places_.size() - 1)];
      if (place == 0 || (place & ~kFound) == key_of(hash)) return place;
    }
  }

  std::vector<std::uint64_t> places_;
  std::size_t missing_ = 0;
};

bool begins_with(const icd::ChunkedBytes& whole, const icd::ChunkedBytes& part) {
  auto chunk = whole.chunks().begin();
  std::size_t at = 0;  // within that chunk
  for (const auto& piece : part.chunks()) {
    for (Point rest = *piece; !rest.empty();) {
      if (chunk == whole.chunks().end()) return false;
      const auto other = (*chunk)->subspan(at);
      const std::size_t size = std::min(rest.size(), other.size());
      if (std::memcmp(rest.data(), other.data(), size) != 0) return false;
      rest = rest.subspan(size);
      at += size;
      if (size == other.size()) ++chunk, at = 0;
    }
  }
  return true;
}

/// Looks for every `every`th point of `older`.
bool has(const icd::ChunkedBytes& newer, const icd::ChunkedBytes& older, std::size_t point_step,
         std::size_t every) {
  PointSet sought(older.size() / point_step / every + 1);
  std::size_t number = 0;
  for_each_point(older, point_step, [&](Point point) {
    if (number++ % every == 0) sought.add(point);
    return true;
  });
  for_each_point(newer, point_step, [&](Point point) {
    sought.on_found(point);
    return sought.missing() > 0;
  });
  return sought.missing() == 0;
}

}  // namespace

/// A sample of points first: it shows that a cloud is another one, with little memory.
bool has_all_points(const icd::MapData& newer, const icd::MapData& older, std::size_t point_step) {
  constexpr std::size_t kFew = 64;
  if (older.bytes.size() > newer.bytes.size()) return false;
  if (begins_with(newer.bytes, older.bytes)) return true;
  const std::size_t points = older.bytes.size() / point_step;
  if (points > kMostComparedPoints - 1) return false;
  return has(newer.bytes, older.bytes, point_step, points / kFew + 1) &&
         has(newer.bytes, older.bytes, point_step, 1);
}

}  // namespace adit::pack
