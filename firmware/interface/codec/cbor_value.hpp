#pragma once

#include <string>
#include <string_view>

#include "codec/value.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// The value of a document that a CborSplitter has checked. Undefined becomes null; only text keys are kept.
Value cbor_value(std::string_view bytes);
/// The same, with arrays left as text. Error 413: as List::element().
icd::Checked<Value> cbor_value_with_lists(std::string bytes);

}  // namespace adit::codec
