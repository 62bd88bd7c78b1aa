#pragma once

#include <string>
#include <string_view>

namespace adit::intake {

/// "; did you mean Cell Phone?" of a type that resembles one of the ICD's ten: but for letter case and
/// whatever is no letter a part of it, or a few letters apart. "" of another.
std::string type_hint(std::string_view type);

}  // namespace adit::intake
