#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace adit::rehearsal {

/// What came in.
using Json = nlohmann::json;

/// What goes out: members stay in the order they were written.
using OrderedJson = nlohmann::ordered_json;

/// One line of JSON; bytes that are not UTF-8 become U+FFFD, since names from the wire may hold anything.
template <class AnyJson>
std::string line_of(const AnyJson& value) {
  return value.dump(-1, ' ', false, AnyJson::error_handler_t::replace);
}

}  // namespace adit::rehearsal
