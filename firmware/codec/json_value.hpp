#pragma once

#include <string>
#include <string_view>

#include "codec/cut_lists.hpp"
#include "codec/value.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// A document that a JsonSplitter has passed and kept, which is not checked again: it is well-formed and
/// without white space.
Value json_value(std::string_view text);
/// The same, its arrays left as text. 413: as List::element().
icd::Checked<Value> json_value_with_lists(std::string text);

/// A number of JSON: an integer where it surely stands for that one alone.
Value json_number_value(double number);

}  // namespace adit::codec
