// The JSON splitter's numbers, and the map's data, which it splits off.
#include <charconv>

#include "codec/json_splitter.hpp"
#include "codec/splitter.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::codec {

icd::Checked<void> JsonSplitter::divert(char first) {
  if (diverted_ == Diversion::Elements) {
    const auto bad = [&](std::string_view got) { return std::unexpected(data_.bad_element(got)); };
    if (first == '"') return bad("a string");
    if (first == '{') return bad("an object");
    if (first == '[') return bad("an array");
    if (first == 't' || first == 'f') return bad("true or false");
    if (first == 'n') return bad("null");
    return {};
  }
  if (auto only = data_.appear(); !only) return only;
  if (first == '"' || first == '[') {
    keep("null");
    diverted_ = first == '"' ? Diversion::Base64 : Diversion::Elements;
    data_.begin(first == '"' ? DataForm::Base64 : DataForm::Integers, path_.is_grid());
  }
  return {};
}

icd::Checked<void> JsonSplitter::decode(std::string_view base64) {
  std::array<std::uint8_t, 6144> bytes;  // not cleared, for speed
  while (!base64.empty()) {
    const auto size = base64_.decode(base64, bytes);
    if (!size) return std::unexpected(bad_data(size.error()));
    if (auto taken = data_.append(std::span(bytes).first(*size)); !taken) return taken;
  }
  return {};
}

/// Decodes up to the string's end without searching for it.
icd::Checked<std::size_t> JsonSplitter::base64_groups(std::string_view in) {
  if (!string_.is_between_characters()) return 0;
  std::array<std::uint8_t, 6144> bytes;  // not cleared, for speed
  std::string_view left = in;
  while (const std::size_t size = base64_.decode_groups(left, bytes)) {
    ADIT_TRY(data_.append(std::span(bytes).first(size)));
  }
  return in.size() - left.size();
}

/// Fast path for elements in their usual form; the general path reads others.
icd::Checked<std::size_t> JsonSplitter::plain_elements(std::string_view in) {
  std::string_view left = in;
  while (const auto elements = take_plain_elements(left)) {
    ADIT_TRY(data_.append_elements(elements->value, elements->count));
    expect_ = Expect::Value;
  }
  return in.size() - left.size();
}

icd::Checked<std::size_t> JsonSplitter::number(std::string_view in) {
  const std::size_t taken = number_.grammar.next(in);
  number_.text += in.substr(0, taken);
  if (taken < in.size()) {
    ADIT_TRY(finish_number(in[taken]));
  }
  return taken;
}

icd::Checked<void> JsonSplitter::finish_number(std::optional<char> next) {
  if (!number_.grammar.complete()) return std::unexpected(fault_at(number_.at, "a number that is cut short"));
  if (number_.grammar.zero() && next && icd::is_digit(*next)) {
    return std::unexpected(fault_at(number_.at, "a number with a leading zero"));
  }
  if (auto taken = diverted_ == Diversion::No ? keep_number() : divert_number(); !taken) return taken;
  number_.text.clear();
  end_value();
  return {};
}

icd::Checked<void> JsonSplitter::keep_number() {
  if (!is_finite(number_.grammar, number_.text))
    return std::unexpected(fault_at(number_.at, "a number too large for a double"));
  keep(number_.text);
  return {};
}

icd::Checked<void> JsonSplitter::divert_number() {
  const char* const first = number_.text.data();
  const char* const last = first + number_.text.size();
  int whole = 0;
  if (const auto [end, error] = std::from_chars(first, last, whole); error == std::errc{} && end == last) {
    return data_.append_element(whole, number_.text);
  }
  double value = 0;
  if (const auto [end, error] = std::from_chars(first, last, value); error == std::errc{} && end == last) {
    return data_.append_element(value, number_.text);
  }
  return std::unexpected(data_.bad_element(number_.text));  // too long, so out of range
}

}  // namespace adit::codec
