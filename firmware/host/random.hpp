#pragma once

#include <cstdint>
#include <span>

namespace adit::host {

/// Fills `bytes` with the kernel's randomness, which is good for secrets. Requires at most 256 of them.
void fill_random(std::span<std::uint8_t> bytes);

}  // namespace adit::host
