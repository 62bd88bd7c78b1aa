#pragma once

#include <string>
#include <string_view>

namespace adit::intake {

/// "; did you mean Cell Phone?" if `type` resembles one of the ICD's ten types, otherwise "". Compares
/// letters only, in any case: one text is a part of the other, or they differ by a few letters.
std::string type_hint(std::string_view type);

}  // namespace adit::intake
