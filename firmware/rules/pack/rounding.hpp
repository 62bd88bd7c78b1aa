#pragma once

#include "icd/map_update.hpp"
#include "pack/arrange.hpp"

namespace adit::pack {

/// Rounds x, y and z to whole steps of `unit` metres, a power of two, so that gzip makes them small. Each
/// coordinate is shifted into the binade of float32 whose steps these are (from 2^23 steps up), because all
/// numbers there have the same exponent. The cloud's origin takes the shift back. float64 becomes float32;
/// other fields keep their bits. If the origin turns the cloud, the points are turned here instead, because
/// turning such large numbers in float32 at the receiver would lose more than the rounding.
///
/// Each point stays within 1.3 units of its place in "darpa", even if the receiver computes in float32. If
/// that is not possible, it returns false and changes nothing:
/// - the points extend over more than the binade, or lie that far from the origin of "darpa" (8192 m for
///   2^-10 m)
/// - the cloud is turned and has fields that may contain a direction
/// - the cloud is big-endian, because a server may object to an origin then
/// - two fields share bytes, or there are no points
///
/// All points are finite (without_invalid_points()).
bool round_to(double unit, Arranged& arranged);

}  // namespace adit::pack
