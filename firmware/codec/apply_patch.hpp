#pragma once

#include <optional>

#include "codec/value.hpp"

namespace adit::codec {

/// What a patch (patch.hpp) makes of what was told before; nothing where it is no patch of that. Both may be
/// anything that a peer sends: nothing in it makes more of it than it says.
std::optional<Value> apply_patch(Value before, const Value& patch);

}  // namespace adit::codec
