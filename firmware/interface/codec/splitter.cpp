#include "codec/splitter.hpp"

#include <algorithm>
#include <cstring>

#include "codec/json_number.hpp"
#include "icd/require.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::codec {
namespace {

/// Passes each member of that name to `visit`; without effect if `value` is not an object.
template <class Visit>
void each_member(Value& value, std::string_view name, const Visit& visit) {
  auto* const object = std::get_if<Value::Object>(&value.is);
  if (object == nullptr) return;
  for (auto& [key, member] : *object) {
    if (key == name) visit(member);
  }
}

}  // namespace

icd::Refusal bad_data(std::string_view why) {
  return {icd::Status::UnprocessableEntity, icd::sentence("msg.data: ", why)};
}

icd::Refusal KeptText::too_large() const {
  return {icd::Status::ContentTooLarge,
          icd::sentence("the document", most_.but, " is larger than the limit of ", most_.text, " bytes")};
}

icd::Refusal KeptText::too_many_values() const {
  return {icd::Status::ContentTooLarge,
          icd::sentence("the document", most_.but, " has more than the limit of ", most_.values, " values")};
}

icd::Refusal too_many_outside_lists(std::size_t most) {
  return {icd::Status::ContentTooLarge,
          icd::sentence("more than the limit of ", most, " values outside lists")};
}

void mark_split_out(Value& root) {
  // A second "msg.data" was refused, so there is at most one.
  each_member(root, "msg",
              [](Value& msg) { each_member(msg, "data", [](Value& data) { data.is = Value::SplitOut{}; }); });
}

namespace {

std::size_t blanks(std::string_view text, std::size_t at) {
  while (at < text.size() && is_blank(text[at])) ++at;
  return at;
}

/// Number of characters from `period` on that equal the ones `period` before them.
std::size_t repeated_length(std::string_view text, std::size_t period) {
  using Word = std::uint64_t;
  std::size_t n = 0;
  const std::size_t most = text.size() - period;
  while (n + sizeof(Word) <= most) {
    Word here = 0, before = 0;
    std::memcpy(&before, text.data() + n, sizeof before);
    std::memcpy(&here, text.data() + n + period, sizeof here);
    if (here != before) break;
    n += sizeof(Word);
  }
  while (n < most && text[n] == text[n + period]) ++n;
  return n;
}

struct Element {
  std::uint8_t value = 0;
  std::size_t end = 0;  // after its last character
};

/// The element at `at`, with a character after it; std::nullopt for another form.
std::optional<Element> element(std::string_view text, std::size_t at) {
  if (text.substr(at).starts_with("-1")) return Element{.value = 255, .end = at + 2};
  constexpr std::size_t kMostDigits = 3;
  unsigned value = 0;
  std::size_t end = at;
  while (end < text.size() && end < at + kMostDigits && icd::is_digit(text[end])) {
    value = 10 * value + static_cast<unsigned>(text[end++] - '0');
  }
  const bool leading_zero = end > at + 1 && text[at] == '0';
  if (end == at || leading_zero || value > 255) return std::nullopt;
  return Element{.value = static_cast<std::uint8_t>(value), .end = end};
}

/// A CBOR element; std::nullopt for another form or an incomplete one.
std::optional<Element> cbor_element(std::string_view bytes) {
  constexpr std::uint8_t kInNextByte = 0x18, kMinusOne = 0x20;
  const auto at = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[i]); };
  if (bytes.empty()) return std::nullopt;
  if (at(0) < kInNextByte) return Element{.value = at(0), .end = 1};
  if (at(0) == kMinusOne) return Element{.value = 255, .end = 1};
  if (at(0) == kInNextByte && bytes.size() > 1) return Element{.value = at(1), .end = 2};
  return std::nullopt;
}

}  // namespace

std::optional<PlainElements> take_plain_elements(std::string_view& text) {
  const auto one = element(text, blanks(text, 0));
  if (!one) return std::nullopt;
  const std::size_t comma = blanks(text, one->end);
  if (comma == text.size() || text[comma] != ',') return std::nullopt;
  // White space after the comma is part of the repeated text: "0, " and "0, ".
  const std::size_t period = comma + 1;
  const std::size_t again = repeated_length(text, period) / period;
  text.remove_prefix(period * (1 + again));
  return PlainElements{.value = one->value, .count = 1 + again};
}

std::optional<PlainElements> take_plain_cbor_elements(std::string_view& bytes, std::uint64_t most) {
  icd::require(most > 0);
  const auto one = cbor_element(bytes);
  if (!one) return std::nullopt;
  const std::uint64_t again = std::min<std::uint64_t>(repeated_length(bytes, one->end) / one->end, most - 1);
  const auto count = static_cast<std::size_t>(1 + again);
  bytes.remove_prefix(one->end * count);
  return PlainElements{.value = one->value, .count = count};
}

}  // namespace adit::codec
