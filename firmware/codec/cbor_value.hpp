#pragma once

#include <string>
#include <string_view>

#include "codec/cut_lists.hpp"
#include "codec/value.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// The document that a CborSplitter has passed and kept, which is not checked again: it is well-formed and
/// has no tags. Undefined is null, and members whose keys are no text are left out.
Value cbor_value(std::string_view bytes);
/// The same, its arrays left as text. 413: as List::element().
icd::Checked<Value> cbor_value_with_lists(std::string bytes);

}  // namespace adit::codec
