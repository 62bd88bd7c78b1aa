#pragma once

#include <cstddef>

#include "icd/map_update.hpp"

namespace adit::bench {

/// What codecs for clouds make of one whose coordinates may be rounded to 2^-10 m, in bytes: a bound for what
/// gzip of a PointCloud2 (ICD 6.3.2) can reach. Float32 and float64, little-endian.

/// As Cloudini does it, with its second stage zstd 1: of coordinates the difference to the point before in
/// whole steps, of integers the difference, each as a number of 7 bits a byte; floats that are no coordinates
/// as they are.
std::size_t by_differences_and_zstd(const icd::MapUpdate& cloud);

/// Google's Draco, points in a k-d tree, speed 5 of 10; other fields as integers of their bits.
std::size_t by_draco(const icd::MapUpdate& cloud);

}  // namespace adit::bench
