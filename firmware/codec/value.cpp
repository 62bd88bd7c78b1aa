#include "codec/value.hpp"

#include <array>

namespace adit::codec {

const char* Value::kind() const {
  constexpr std::array<const char*, 11> kKinds = {
      "null",          "true or false",   "a whole number", "a whole number", "a number", "a string",
      "a byte string", "split-out bytes", "an array",       "an object",      "an array"};
  static_assert(kKinds.size() == std::variant_size_v<decltype(is)>);
  return kKinds[is.index()];
}

bool operator==(const Value& one, const Value& other) {
  return one.is == other.is;
}

}  // namespace adit::codec
