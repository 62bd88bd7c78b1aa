#include "codec/json_value.hpp"

#include <charconv>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "codec/body_decoder.hpp"
#include "codec/json_characters.hpp"
#include "codec/json_number.hpp"
#include "codec/json_string.hpp"
#include "codec/splitter.hpp"
#include "icd/require.hpp"

namespace adit::codec {
namespace {

/// Each function reads what its name says and moves on behind it; false: the document cannot be read.
class JsonReader {
 public:
  /// `lists`: stand for the arrays, which are empty; null: there are none such.
  JsonReader(std::string_view text, std::size_t most_values, Lists* lists)
      : at_(text.data()), end_(text.data() + text.size()), values_left_(most_values), lists_(lists) {}

  bool document(Value& into) {
    if (!value(into)) return false;
    skip_blanks();
    return at_ == end_;
  }

 private:
  char next() const { return at_ == end_ ? '\0' : *at_; }
  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }
  bool take(char c) {
    skip_blanks();
    if (next() != c) return false;
    ++at_;
    return true;
  }

  bool value(Value& into) {
    skip_blanks();
    if (values_left_ == 0) return false;
    --values_left_;
    switch (next()) {
      case '"':
        return string(into.is.emplace<std::string>());
      case '{':
        return nested([&] { return object(into); });
      case '[':
        return nested([&] { return array(into); });
      case 't':
        return word("true", {true}, into);
      case 'f':
        return word("false", {false}, into);
      case 'n':
        return word("null", {}, into);
      default:
        return number(into);
    }
  }

  template <class Read>
  bool nested(Read read) {
    if (depth_ == BodyDecoder::kDeepest) return false;
    ++at_;
    ++depth_;
    const bool is_read = read();
    --depth_;
    return is_read;
  }

  bool word(std::string_view word, Value meaning, Value& into) {
    if (!std::string_view(at_, end_).starts_with(word)) return false;
    at_ += word.size();
    into = std::move(meaning);
    return true;
  }

  bool string(std::string& into) {
    const char* const begin = ++at_;
    while (at_ != end_ && is_plain(*at_)) ++at_;
    into.assign(begin, at_);
    if (next() != '"') return rest_of_string(into);
    ++at_;
    return true;
  }

  /// From the first escape, or the first character that is not ASCII.
  bool rest_of_string(std::string& into) {
    JsonString characters;
    for (bool ended = false; !ended;) {
      if (at_ == end_) return false;
      const auto piece = characters.next({at_, end_});
      if (!piece) return false;
      into += piece->text;
      at_ += piece->taken;
      ended = piece->ended;
    }
    return true;
  }

  bool number(Value& into) {
    JsonNumber grammar;
    std::string_view text(at_, grammar.next({at_, end_}));
    at_ += text.size();
    if (!grammar.complete()) return false;
    const double number = take_json_number(text);
    into = json_number_value(number);
    return !std::isinf(number);
  }

  /// The last ones of `waiting`, from `first` on, which have no other place there.
  template <class Item>
  static std::vector<Item> take_from(std::vector<Item>& waiting, std::size_t first) {
    const auto begin = waiting.begin() + static_cast<std::ptrdiff_t>(first);
    std::vector<Item> taken(std::make_move_iterator(begin), std::make_move_iterator(waiting.end()));
    waiting.erase(begin, waiting.end());
    return taken;
  }

  bool array(Value& into) {
    const std::size_t first = elements_.size();
    if (!take(']')) {
      do {
        Value element;
        if (!value(element)) return false;
        elements_.push_back(std::move(element));
      } while (take(','));
      if (!take(']')) return false;
    }
    into = lists_ != nullptr ? lists_->next() : Value{take_from(elements_, first)};
    return true;
  }

  bool object(Value& into) {
    const std::size_t first = members_.size();
    if (!take('}')) {
      do {
        std::string name;
        Value meant;
        skip_blanks();
        if (next() != '"' || !string(name) || !take(':') || !value(meant)) return false;
        members_.emplace_back(std::move(name), std::move(meant));
      } while (take(','));
      if (!take('}')) return false;
    }
    into.is.emplace<Value::Object>(take_from(members_, first));
    return true;
  }

  const char* at_;
  const char* end_;
  std::size_t values_left_;
  Lists* lists_;
  int depth_ = 0;
  // Of all that are open, so that each gets room for what it holds and no more.
  std::vector<Value> elements_;
  std::vector<Value::Member> members_;
};

/// List::reals() of well-formed text without white space.
bool reals_in(std::string_view object, std::span<const std::string_view> names, std::span<double> into) {
  const auto takes = [&](std::string_view what) {
    if (!object.starts_with(what)) return false;
    object.remove_prefix(what.size());
    return true;
  };
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!takes(i == 0 ? "{\"" : ",\"") || !takes(names[i]) || !takes("\":")) return false;
    const auto [after, error] = std::from_chars(object.begin(), object.end(), into[i]);
    if (error != std::errc()) return false;
    object = {after, object.end()};
  }
  return object == "}";
}

icd::Checked<Value> with_lists(const SharedText& text, std::size_t begin, std::size_t end);
constexpr Lists::Format kJsonLists = {.element = with_lists, .reals = reals_in, .gap = 1};

/// The value from `begin` to `end`.
icd::Checked<Value> with_lists(const SharedText& text, std::size_t begin, std::size_t end) {
  Cut cut = cut_json(*text, begin, end);
  if (cut.values > kMostOutsideLists) return std::unexpected(too_many_outside_lists(kMostOutsideLists));
  Lists lists(text, std::move(cut.arrays), kJsonLists);
  Value root;
  icd::require(JsonReader(cut.rest, cut.rest.size(), &lists).document(root));
  return root;
}

}  // namespace

Value json_number_value(double number) {
  constexpr double kWholeBelow = 9007199254740992;  // 2^53: from there on it may stand for another integer
  const bool whole = std::abs(number) < kWholeBelow && number == std::floor(number);
  const bool negative_zero = number == 0 && std::signbit(number);
  if (whole && !negative_zero) return {static_cast<std::int64_t>(number)};
  return {number};
}

std::optional<Value> json_value(std::string_view text, std::size_t most_values) {
  Value root;
  if (!JsonReader(text, most_values, nullptr).document(root)) return std::nullopt;
  return root;
}

icd::Checked<Value> json_value_with_lists(std::string text) {
  const auto kept = std::make_shared<const std::string>(std::move(text));
  return with_lists(kept, 0, kept->size());
}

}  // namespace adit::codec
