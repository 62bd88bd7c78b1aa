#pragma once

#include <string>

#include "codec/value.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// The document that a JsonSplitter has passed and kept, by cJSON. U+FFFF stands for NUL.
icd::Checked<Value> json_value(const std::string& text);

}  // namespace adit::codec
