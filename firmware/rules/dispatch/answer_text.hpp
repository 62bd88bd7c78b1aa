#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace adit::dispatch {

/// The answer's text for people: a JSON string, an object's `detail`, or else the status. Cut at 300 bytes.
std::string answer_text(int status, std::string_view body);

/// "too large (1440 kB): the Command Post answered 413"
std::string oversize_text(std::size_t bytes, std::string_view body);

/// "the Command Post answered 404"
std::string answered_with(int status);

}  // namespace adit::dispatch
