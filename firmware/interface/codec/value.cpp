#include "codec/value.hpp"

#include <array>

#include "codec/cbor.hpp"
#include "icd/require.hpp"

namespace adit::codec {

std::string Value::kind() const {
  constexpr std::array<const char*, 12> kKinds = {
      "null", "true or false",   "a whole number", "a whole number", "a number", "a string", "a byte string",
      "",     "split-out bytes", "an array",       "an object",      "an array"};
  static_assert(kKinds.size() == std::variant_size_v<decltype(is)>);
  const auto* const under = std::get_if<TaggedValue>(&is);
  return under == nullptr ? kKinds[is.index()] : tag_that_changes(under->tag);
}

bool operator==(const Value& one, const Value& other) {
  return one.is == other.is;
}

icd::Checked<Value> List::element(std::size_t index) const {
  icd::require(index < size());
  return format_.element(text_, starts_[index], end_of(index));
}

bool List::reals(std::size_t index, std::span<const std::string_view> names, std::span<double> into) const {
  icd::require(index < size() && names.size() == into.size());
  const std::string_view text = *text_;
  return format_.reals(text.substr(starts_[index], end_of(index) - starts_[index]), names, into);
}

}  // namespace adit::codec
