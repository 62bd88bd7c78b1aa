#include "icd/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace adit::icd {

std::optional<Quaternion> rotation_of(const Quaternion& q) {
  if (!std::isfinite(q.x) || !std::isfinite(q.y) || !std::isfinite(q.z) || !std::isfinite(q.w)) return {};
  const double largest = std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z), std::abs(q.w)});
  if (largest == 0) return Quaternion{};
  const double x = q.x / largest, y = q.y / largest, z = q.z / largest, w = q.w / largest;
  const double norm = std::sqrt(x * x + y * y + z * z + w * w);  // from 1 to 2 for any length of `q`
  const double length = largest * norm;
  if (length < kLengthNoise) return {};
  if (std::abs(length - 1) <= kLengthNoise) return q;
  return Quaternion{x / norm, y / norm, z / norm, w / norm};
}

}  // namespace adit::icd
