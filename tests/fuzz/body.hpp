#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "codec/body_decoder.hpp"

namespace adit::fuzz {

/// One input: a body, and behind it two bytes that say how it is read. (Behind, so that a seed is a plain
/// body with a line end.) Traps where a law of the codec is broken.
void try_body(codec::Format format, std::span<const std::uint8_t> input);

}  // namespace adit::fuzz
