#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <vector>

#include "icd/mapping.hpp"

namespace adit::bench {

/// A map as its robot sends it, not compressed.
struct SizedMap {
  std::string name;
  icd::MapUpdate update;
};

/// The recorded maps in `folder`, none where there is no such folder. A .pgm without a .yaml is a cost map,
/// whose greys are costs.
std::expected<std::vector<SizedMap>, std::string> recorded_maps(const std::string& folder);

/// Grids of all kinds. `is_short`: without the large ones. Another `seed` gives other maps of the same kinds.
std::vector<SizedMap> generated_grids(bool is_short, std::uint64_t seed);
/// Clouds of noise and of surveys, with and without padding (sizes_clouds.cpp).
std::vector<SizedMap> generated_clouds(bool is_short, std::uint64_t seed);

}  // namespace adit::bench
