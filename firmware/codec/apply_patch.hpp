#pragma once

#include <optional>

#include "codec/value.hpp"

namespace adit::codec {

/// Applies a patch (patch.hpp) to the value before it. std::nullopt: not a patch of that value. Both may come
/// from any peer; the result's size is limited.
std::optional<Value> apply_patch(Value before, const Value& patch);

}  // namespace adit::codec
