#include "codec/quick_json.hpp"

#include <charconv>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "codec/body_decoder.hpp"
#include "codec/json_characters.hpp"
#include "codec/json_number.hpp"
#include "codec/json_value.hpp"

namespace adit::codec {
namespace {

/// Each function reads what its name says and moves on behind it; false: this document is not to be read so.
class QuickReader {
 public:
  QuickReader(std::string_view text, std::size_t most_values)
      : at_(text.data()), end_(text.data() + text.size()), values_left_(most_values) {}

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
    if (next() != '"') return false;
    into.assign(begin, at_++);
    return true;
  }

  bool number(Value& into) {
    JsonNumber grammar;
    const char* const begin = at_;
    at_ += grammar.next({at_, end_});
    double number = 0;
    if (!grammar.complete() || std::from_chars(begin, at_, number).ec != std::errc()) return false;
    into = json_number_value(number);
    return true;
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
    into.is.emplace<Value::Array>(take_from(elements_, first));
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
  int depth_ = 0;
  // Of all that are open, so that each gets room for what it holds and no more.
  std::vector<Value> elements_;
  std::vector<Value::Member> members_;
};

}  // namespace

std::optional<Value> quick_json(std::string_view text, std::size_t most_values) {
  Value root;
  if (!QuickReader(text, most_values).document(root)) return std::nullopt;
  return root;
}

}  // namespace adit::codec
