#pragma once

#include "icd/map_update.hpp"
#include "pack/arrange.hpp"

namespace adit::pack {

/// Rounds x, y and z to whole steps of `unit` metres, a power of two, so that gzip makes them small: each is
/// shifted into the one binade of float32 whose steps these are, from 2^23 of them up, where all have the
/// same exponent, and the cloud's origin takes the shift back. float64 becomes float32; other fields stay as
/// they are, bit for bit. Where the origin turns the cloud, its points are turned instead: a receiver that
/// turned such large numbers in float32 would lose more than rounding does.
///
/// A point is then where it was, in "darpa", but for 1.3 units of distance, also at a receiver that computes
/// in float32. False, and nothing is changed, where that cannot be held: where points lie further apart than
/// the binade is wide, or as far from the origin of "darpa" (8192 m for 2^-10 m); where the cloud is turned
/// and has fields that may say a direction; or where it is big-endian, for there is a server that minds an
/// origin then. For finite points (without_invalid_points).
bool round_to(double unit, Arranged& arranged);

}  // namespace adit::pack
