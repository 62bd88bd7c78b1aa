#pragma once

#include <string>
#include <string_view>

namespace adit::intake {

/// "; did you mean Cell Phone?" if the type resembles one of the ICD's ten: without letter case and
/// characters other than letters, it is a part of that one or differs by a few letters. Otherwise "".
std::string type_hint(std::string_view type);

}  // namespace adit::intake
