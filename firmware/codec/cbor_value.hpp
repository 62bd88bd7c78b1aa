#pragma once

#include <string>

#include "codec/value.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// The document that a CborSplitter has passed and kept, by libcbor. Tags are skipped, undefined is null, and
/// members whose keys are no text are left out.
icd::Checked<Value> cbor_value(const std::string& bytes);

}  // namespace adit::codec
