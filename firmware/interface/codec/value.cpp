#include "codec/value.hpp"

#include <array>

#include "codec/cbor.hpp"

namespace adit::codec {

std::string Value::kind() const {
  constexpr std::array<const char*, 12> kKinds = {
      "null", "true or false",   "a whole number", "a whole number", "a number", "a string", "a byte string",
      "",     "split-out bytes", "an array",       "an object",      "an array"};
  static_assert(kKinds.size() == std::variant_size_v<decltype(is)>);
  const auto* const under = std::get_if<UnderTag>(&is);
  return under == nullptr ? kKinds[is.index()] : tag_that_changes(under->tag);
}

bool operator==(const Value& one, const Value& other) {
  return one.is == other.is;
}

}  // namespace adit::codec
