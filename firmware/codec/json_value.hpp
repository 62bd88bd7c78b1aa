#pragma once

#include <string>

#include "codec/value.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// A document by cJSON, which takes more than RFC 8259 does: see JsonSplitter and is_plain(). U+FFFF stands
/// for NUL.
icd::Checked<Value> json_value(const std::string& text);

}  // namespace adit::codec
