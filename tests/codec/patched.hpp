#pragma once

#include "codec/value.hpp"

namespace adit::codec::test {

/// Applies a patch (codec/patch.hpp) to a value. A second implementation, from the API's README.md.
Value patched(const Value& value, const Value& patch);

}  // namespace adit::codec::test
