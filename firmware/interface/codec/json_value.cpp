#include "codec/json_value.hpp"

#include <charconv>
#include <cmath>
#include <memory>
#include <utility>

#include "codec/body_decoder.hpp"
#include "codec/json_number.hpp"
#include "codec/json_splitter.hpp"
#include "codec/splitter.hpp"

namespace adit::codec {
namespace {

bool reals_in(std::string_view object, std::span<const std::string_view> names, std::span<double> into);
icd::Checked<Value> element_at(const SharedText& text, std::size_t begin, std::size_t end);
constexpr std::size_t kUsualMembers = 4;  // of an object: a quaternion
constexpr List::Format kJsonLists = {.element = element_at, .reals = reals_in, .gap = 1};

/// Whether the number stands for exactly one integer.
bool is_whole(double number) {
  constexpr double kWholeBelow = 9007199254740992;  // 2^53: larger ones may stand for another integer
  const bool negative_zero = number == 0 && std::signbit(number);
  return std::abs(number) < kWholeBelow && number == std::floor(number) && !negative_zero;
}

/// Each function reads the named item and moves past it. False: invalid document.
class JsonReader {
 public:
  JsonReader(std::string_view text, std::size_t most_values)
      : at_(text.data()), end_(text.data() + text.size()), values_left_(most_values) {}
  /// Leaves the arrays of a part of `whole` as text.
  JsonReader(std::string_view part, const SharedText& whole, std::size_t most_values)
      : JsonReader(part, most_values) {
    whole_ = &whole;
    outside_left_ = kMostOutsideLists;
  }

  bool document(Value& into) {
    if (!value(&into)) return false;
    skip_blanks();
    return at_ == end_;
  }

 private:
  char next() const { return at_ == end_ ? '\0' : *at_; }
  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }
  bool consume(char c) {
    skip_blanks();
    if (next() != c) return false;
    ++at_;
    return true;
  }

  /// `into`, here and below: null if the value is only checked.
  bool value(Value* into) {
    skip_blanks();
    if (values_left_ == 0 || (into != nullptr && outside_left_ == 0)) return false;
    --values_left_;
    if (into != nullptr) --outside_left_;
    switch (next()) {
      case '"':
        return string(into == nullptr ? nullptr : &into->is.emplace<std::string>());
      case '{':
        return read_nested([&] { return object(into); });
      case '[':
        return read_nested([&] { return array(into); });
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
  bool read_nested(Read read) {
    if (depth_ == BodyDecoder::kDeepest) return false;
    ++at_;
    ++depth_;
    const bool is_read = read();
    --depth_;
    return is_read;
  }

  bool word(std::string_view word, Value meaning, Value* into) {
    if (!std::string_view(at_, end_).starts_with(word)) return false;
    at_ += word.size();
    if (into != nullptr) *into = std::move(meaning);
    return true;
  }

  bool string(std::string* into) {
    const char* const begin = ++at_;
    while (at_ != end_ && is_plain(*at_)) ++at_;
    if (into != nullptr) into->assign(begin, at_);
    if (next() != '"') return rest_of_string(into);
    ++at_;
    return true;
  }

  /// From the first escape, or the first character that is not ASCII.
  bool rest_of_string(std::string* into) {
    JsonString characters;
    for (bool ended = false; !ended;) {
      if (at_ == end_) return false;
      const auto piece = characters.next({at_, end_});
      if (!piece) return false;
      if (into != nullptr) *into += piece->text;
      at_ += piece->taken;
      ended = piece->ended;
    }
    return true;
  }

  bool number(Value* into) {
    JsonNumber grammar;
    std::string_view text(at_, grammar.next({at_, end_}));
    at_ += text.size();
    if (!grammar.complete()) return false;
    if (into == nullptr) return is_finite(grammar, text);
    const double number = take_json_number(text);
    if (is_whole(number)) {
      into->is.emplace<std::int64_t>(static_cast<std::int64_t>(number));
    } else {
      into->is.emplace<double>(number);
    }
    return !std::isinf(number);
  }

  /// Reads the items up to the closing `bracket`. `each` starts after the opening bracket or a comma.
  template <class Each>
  bool items(char bracket, Each each) {
    if (consume(bracket)) return true;
    do {
      if (!each()) return false;
    } while (consume(','));
    return consume(bracket);
  }

  bool array(Value* into) {
    if (into == nullptr) return items(']', [&] { return value(nullptr); });
    if (whole_ != nullptr) return list(*into);
    auto& elements = into->is.emplace<Value::Array>();
    return items(']', [&] { return value(&elements.emplace_back()); });
  }

  bool list(Value& into) {
    List::Starts starts;
    const auto offset = [this] {
      return static_cast<std::uint32_t>(at_ - (*whole_)->data());  // a text with lists has a few MB
    };
    const auto element = [&] {
      starts.push_back(offset());
      return value(nullptr);
    };
    if (!items(']', element)) return false;
    if (!starts.empty()) starts.push_back(offset());
    into.is = std::make_shared<const List>(*whole_, std::move(starts), kJsonLists);
    return true;
  }

  bool name(std::string* into) {
    skip_blanks();
    return next() == '"' && string(into) && consume(':');
  }

  bool object(Value* into) {
    if (into == nullptr) return items('}', [&] { return name(nullptr) && value(nullptr); });
    auto& members = into->is.emplace<Value::Object>();
    return items('}', [&] {
      if (members.empty()) members.reserve(kUsualMembers);
      Value::Member& member = members.emplace_back(std::string(), Value());
      return name(&member.first) && value(&member.second);
    });
  }

  const char* at_;
  const char* end_;
  std::size_t values_left_;
  std::size_t outside_left_ = std::numeric_limits<std::size_t>::max();  // values that are kept
  const SharedText* whole_ = nullptr;                                   // null: no array is left as text
  int depth_ = 0;
};

/// List::reals() of well-formed text.
bool reals_in(std::string_view object, std::span<const std::string_view> names, std::span<double> into) {
  const auto skip_blanks = [&] {
    while (!object.empty() && is_blank(object.front())) object.remove_prefix(1);
  };
  const auto takes = [&](std::string_view what) {
    if (!object.starts_with(what)) return false;
    object.remove_prefix(what.size());
    return true;
  };
  const auto takes_next = [&](std::string_view what) {
    skip_blanks();
    return takes(what);
  };
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!takes_next(i == 0 ? "{" : ",") || !takes_next("\"") || !takes(names[i]) || !takes("\"") ||
        !takes_next(":"))
      return false;
    skip_blanks();
    const auto [after, error] = std::from_chars(object.begin(), object.end(), into[i]);
    if (error != std::errc()) return false;
    object = {after, object.end()};
  }
  return takes_next("}");
}

/// Of well-formed text.
icd::Checked<Value> element_at(const SharedText& text, std::size_t begin, std::size_t end) {
  Value element;
  const std::string_view part(text->data() + begin, end - begin);
  if (JsonReader(part, text, part.size()).document(element)) return element;
  return std::unexpected(too_many_outside_lists(kMostOutsideLists));
}

}  // namespace

Value json_number_value(double number) {
  if (is_whole(number)) return {static_cast<std::int64_t>(number)};
  return {number};
}

std::optional<Value> json_value(std::string_view text, std::size_t most_values) {
  Value root;
  if (!JsonReader(text, most_values).document(root)) return std::nullopt;
  return root;
}

std::optional<Value> json_value_with_lists(const SharedText& text, std::size_t most_values) {
  Value root;
  if (!JsonReader(*text, text, most_values).document(root)) return std::nullopt;
  return root;
}

}  // namespace adit::codec
