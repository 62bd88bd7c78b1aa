#pragma once

#include <string>

#include "codec/cut_lists.hpp"
#include "codec/value.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// A document by cJSON, which takes more than RFC 8259 does: see JsonSplitter and is_plain(). U+FFFF stands
/// for NUL. `lists`: what stands for its arrays; null: they are parsed.
icd::Checked<Value> json_value(const std::string& text, Lists* lists = nullptr);
/// The same of what a JsonSplitter has passed, its arrays left as text. 413: as List::element().
icd::Checked<Value> json_value_with_lists(std::string text);

}  // namespace adit::codec
