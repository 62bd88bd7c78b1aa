#include "codec/json_value.hpp"

#include <cmath>
#include <memory>

#include "codec/json_number.hpp"
#include "codec/json_string.hpp"
#include "codec/splitter.hpp"

namespace adit::codec {
namespace {

/// Reads text that is known to be well-formed and without white space. Recursion ends at
/// BodyDecoder::kDeepest.
class JsonReader {
 public:
  JsonReader(std::string_view text, Lists* lists) : left_(text), lists_(lists) {}

  Value value() {
    switch (left_[0]) {
      case '"':
        return {string()};
      case '{':
        return object();
      case '[':
        return array();
      case 't':
        return literal("true", {true});
      case 'f':
        return literal("false", {false});
      case 'n':
        return literal("null", {});
      default:
        return json_number_value(take_json_number(left_));
    }
  }

 private:
  Value literal(std::string_view word, Value meaning) {
    left_.remove_prefix(word.size());
    return meaning;
  }

  std::string string() {
    left_.remove_prefix(1);
    std::string text;
    JsonString characters;
    for (bool ended = false; !ended;) {
      const auto piece = characters.next(left_);
      text += piece->text;
      ended = piece->ended;
      left_.remove_prefix(piece->taken);
    }
    return text;
  }

  /// Takes the bracket or the comma before the next one; false: the last bracket.
  bool take_before_next(char last) {
    const bool is_over = left_[0] == last || (left_[0] != ',' && left_[1] == last);
    left_.remove_prefix(is_over && left_[0] != last ? 2 : 1);
    return !is_over;
  }

  Value array() {
    Value::Array array;
    while (take_before_next(']')) array.push_back(value());
    if (lists_ != nullptr) return lists_->next();  // of a Cut, it is empty
    return {std::move(array)};
  }

  Value object() {
    Value::Object object;
    while (take_before_next('}')) {
      std::string name = string();
      left_.remove_prefix(1);  // the colon
      object.emplace_back(std::move(name), value());
    }
    return {std::move(object)};
  }

  std::string_view left_;
  Lists* lists_;
};

/// The value from `begin` to `end`.
icd::Checked<Value> with_lists(const SharedText& text, std::size_t begin, std::size_t end) {
  Cut cut = cut_json(*text, begin, end);
  if (cut.values > kMostOutsideLists) return std::unexpected(too_many_outside_lists(kMostOutsideLists));
  Lists lists(text, std::move(cut.arrays), with_lists, 1);
  return JsonReader(cut.rest, &lists).value();
}

}  // namespace

Value json_number_value(double number) {
  constexpr double kWholeBelow = 9007199254740992;  // 2^53: from there on it may stand for another integer
  const bool whole = std::abs(number) < kWholeBelow && number == std::floor(number);
  const bool negative_zero = number == 0 && std::signbit(number);
  if (whole && !negative_zero) return {static_cast<std::int64_t>(number)};
  return {number};
}

Value json_value(std::string_view text) {
  return JsonReader(text, nullptr).value();
}

icd::Checked<Value> json_value_with_lists(std::string text) {
  const auto kept = std::make_shared<const std::string>(std::move(text));
  return with_lists(kept, 0, kept->size());
}

}  // namespace adit::codec
