#pragma once

#include "codec/value.hpp"

namespace adit::codec::test {

/// What a patch (codec/patch.hpp) makes of a value, written a second time, as README.md of the API says it.
Value patched(const Value& value, const Value& patch);

}  // namespace adit::codec::test
