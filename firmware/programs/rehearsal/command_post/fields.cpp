#include "rehearsal/command_post/fields.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace adit::rehearsal {
namespace {

std::string kind_of(const Json& value) {
  switch (value.type()) {
    case Json::value_t::null:
      return "null";
    case Json::value_t::object:
      return "an object";
    case Json::value_t::array:
      return "an array";
    case Json::value_t::string:
      return "a text string";
    case Json::value_t::boolean:
      return "a boolean";
    case Json::value_t::number_integer:
    case Json::value_t::number_unsigned:
    case Json::value_t::number_float:
      return line_of(value);
    case Json::value_t::binary:
      return "a byte string";
    case Json::value_t::discarded:
      break;
  }
  return "nothing";
}

/// Integers over int64_t become the largest one, which no field may hold.
std::int64_t integer_of(const Json& value) {
  if (!value.is_number_unsigned()) return value.get<std::int64_t>();
  constexpr auto most = static_cast<std::uint64_t>(INT64_MAX);
  return static_cast<std::int64_t>(std::min(value.get<std::uint64_t>(), most));
}

}  // namespace

std::string Field::path_of(std::string_view name) const {
  return path_.empty() ? std::string(name) : path_ + "." + std::string(name);
}

void Field::breaks(std::string_view what, Measured measured) const {
  const std::string where = path_.empty() ? "the body" : path_;
  findings_->breaks(where + ": " + std::string(what), measured);
}

void Field::expected(std::string_view what) const {
  breaks("expected " + std::string(what) + ", got " + kind_of(*value_));
}

std::optional<Field> Field::optional_member(const char* name) const {
  if (!value_->is_object()) return std::nullopt;
  const auto found = value_->find(name);
  if (found == value_->end()) return std::nullopt;
  return Field(*found, path_of(name), *findings_);
}

std::optional<Field> Field::member(const char* name, Measured measured) const {
  if (!is_object()) return std::nullopt;
  auto found = optional_member(name);
  if (!found) findings_->breaks("Missing field '" + path_of(name) + "'", measured);
  return found;
}

std::optional<std::vector<Field>> Field::elements() const {
  if (!value_->is_array()) {
    expected("an array");
    return std::nullopt;
  }
  std::vector<Field> all;
  all.reserve(value_->size());
  for (const Json& element : *value_) {
    all.emplace_back(element, path_ + "[" + std::to_string(all.size()) + "]", *findings_);
  }
  return all;
}

bool Field::is_object() const {
  if (!value_->is_object()) expected("an object");
  return value_->is_object();
}

std::optional<double> Field::number() const {
  if (!value_->is_number()) {
    expected("a number");
    return std::nullopt;
  }
  const auto number = value_->get<double>();
  if (!std::isfinite(number)) {  // CBOR can say so, JSON cannot
    breaks("expected a finite number");
    return std::nullopt;
  }
  return number;
}

std::optional<std::int64_t> Field::integer(std::int64_t least, std::int64_t most) const {
  const std::string range = "an integer from " + std::to_string(least) + " to " + std::to_string(most);
  if (!value_->is_number_integer()) {
    expected(range);
    return std::nullopt;
  }
  const std::int64_t integer = integer_of(*value_);
  if (integer < least || integer > most) {
    expected(range);
    return std::nullopt;
  }
  return integer;
}

std::optional<bool> Field::boolean() const {
  if (!value_->is_boolean()) {
    expected("a boolean");
    return std::nullopt;
  }
  return value_->get<bool>();
}

std::optional<std::string> Field::text() const {
  if (!value_->is_string()) {
    expected("a text string");
    return std::nullopt;
  }
  return value_->get<std::string>();
}

std::optional<double> Field::number(const char* name) const {
  const auto field = member(name);
  return field ? field->number() : std::nullopt;
}

std::optional<std::int64_t> Field::integer(const char* name, std::int64_t least, std::int64_t most) const {
  const auto field = member(name);
  return field ? field->integer(least, most) : std::nullopt;
}

std::optional<std::string> Field::text(const char* name) const {
  const auto field = member(name);
  return field ? field->text() : std::nullopt;
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view space = " \t\r\n";
  const auto first = text.find_first_not_of(space);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(space) - first + 1);
}

bool is_word_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

std::string tame(std::string_view text) {
  constexpr std::size_t longest = 32;
  std::string tamed(text.substr(0, longest));
  std::ranges::replace_if(tamed, std::not_fn(is_word_character), '_');
  return tamed;
}

bool is_robot_name(std::string_view name) {
  return !name.empty() && name.size() <= 10 && std::ranges::all_of(name, is_word_character);
}

}  // namespace adit::rehearsal
