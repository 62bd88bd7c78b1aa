#pragma once

#include <string>
#include <string_view>

namespace adit::dispatch {

/// What the Command Post said in an answer, for people: a JSON string without its quotation marks, `detail`
/// of an object, else the status alone. At most 300 bytes.
std::string said(int status, std::string_view body);

/// "the Command Post answered 404"
std::string answered_with(int status);

}  // namespace adit::dispatch
