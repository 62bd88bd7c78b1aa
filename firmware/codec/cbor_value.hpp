#pragma once

#include <string>

#include "codec/cut_lists.hpp"
#include "codec/value.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// The document that a CborSplitter has passed and kept, by libcbor. Tags are skipped, undefined is null, and
/// members whose keys are no text are left out. `lists`: what stands for its arrays; null: they are parsed.
icd::Checked<Value> cbor_value(const std::string& bytes, Lists* lists = nullptr);
/// The same, its arrays left as text. 413: as List::element().
icd::Checked<Value> cbor_value_with_lists(std::string bytes);

}  // namespace adit::codec
