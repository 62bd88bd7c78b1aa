#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "icd/map_update.hpp"

namespace adit::pack {

/// Gives each point of `bytes` (point_step bytes) to `visit`, in order, wherever chunks end.
template <class Visit>
void for_each_point(const icd::ChunkedBytes& bytes, std::size_t point_step, Visit visit) {
  std::vector<std::uint8_t> cut;  // a point of which only the first bytes have come
  for (const auto& chunk : bytes.chunks()) {
    std::span<const std::uint8_t> rest{*chunk};
    if (!cut.empty()) {
      const auto more = rest.first(std::min(rest.size(), point_step - cut.size()));
      cut.insert(cut.end(), more.begin(), more.end());
      rest = rest.subspan(more.size());
      if (cut.size() < point_step) continue;
      visit(std::span<const std::uint8_t>{cut});
      cut.clear();
    }
    for (; rest.size() >= point_step; rest = rest.subspan(point_step)) visit(rest.first(point_step));
    cut.assign(rest.begin(), rest.end());
  }
}

/// Tells whether a point's x, y and z are all finite, by their exponents alone (IEEE 754): no alignment and
/// no swapping of bytes is needed.
class FiniteCheck {
 public:
  explicit FiniteCheck(const icd::PointCloud2& cloud);

  bool operator()(std::span<const std::uint8_t> point) const {
    for (const Exponent& exponent : exponents_) {
      if ((point[exponent.high] & kHighBits) == kHighBits && (point[exponent.low] & low_bits_) == low_bits_) {
        return false;  // infinite or not a number: all bits of the exponent are set
      }
    }
    return true;
  }

 private:
  struct Exponent {
    std::size_t high = 0, low = 0;  // where its two bytes stand in a point
  };
  static constexpr std::uint8_t kHighBits = 0x7f;
  std::uint8_t low_bits_ = 0;  // 1 bit in a float32, 4 in a float64
  std::array<Exponent, 3> exponents_;
};

}  // namespace adit::pack
