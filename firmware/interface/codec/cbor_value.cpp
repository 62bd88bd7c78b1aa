#include "codec/cbor_value.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "codec/cbor.hpp"
#include "codec/splitter.hpp"
#include "codec/utf8.hpp"
#include "icd/require.hpp"

namespace adit::codec {
namespace {

Value negative(std::uint64_t argument) {  // RFC 8949 3.1: the value is -1 - argument
  if (argument <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
    return {-1 - static_cast<std::int64_t>(argument)};
  }
  return {-1.0 - static_cast<double>(argument)};
}

Value integer_value(std::uint64_t number) {
  if (number <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
    return {static_cast<std::int64_t>(number)};
  }
  return {number};
}

Value simple(const CborHead& head) {
  constexpr std::uint8_t kFalse = 20, kTrue = 21, kHalf = 25;
  if (head.info() >= kHalf) return {head.number()};
  if (head.info() == kFalse || head.info() == kTrue) return {head.info() == kTrue};
  return {};
}

icd::Checked<Value> parse_with_lists(const SharedText& text, std::size_t begin, std::size_t end);
bool reals_in(std::string_view object, std::span<const std::string_view> names, std::span<double> into);
constexpr List::Format kCborLists = {.element = parse_with_lists, .reals = reals_in, .gap = 0};

/// Moves past the next head of well-formed items.
CborHead take_head(std::string_view& items) {
  CborHead head;
  items.remove_prefix(head.next(items));
  return head;
}

/// Moves past the elements, pairs or chunks of an item with this head. `visit` moves past one of them.
template <class Visit>
void take_each(std::string_view& items, const CborHead& head, const Visit& visit) {
  if (!head.indefinite()) {
    for (std::uint64_t left = head.argument(); left > 0; --left) visit();
    return;
  }
  while (items[0] != '\xFF') visit();
  items.remove_prefix(1);
}

/// The value at the beginning of a text, with its outermost arrays replaced by empty ones.
struct Cut {
  std::string rest;
  std::vector<List::Starts> arrays;  // in order
  std::size_t values = 0;            // number of values in `rest`
};

/// Walks well-formed items. BodyDecoder::kDeepest limits the recursion.
class CborCutter {
 public:
  CborCutter(std::string_view text, std::size_t begin, Cut& cut)
      : text_(text), left_(text.substr(begin)), cut_(cut) {}

  /// Copies an item without its outermost arrays.
  void keep() {
    ++cut_.values;
    const std::size_t begin = at();
    const CborHead head = take_head(left_);
    if (head.major() == Major::Array) {
      cut_.rest += '\x80';
      cut_.arrays.push_back(starts_in(head));
    } else if (head.major() == Major::Map) {
      cut_.rest += head.raw();
      take_each(left_, head, [this] { keep_member(); });
      if (head.indefinite()) cut_.rest += '\xFF';
    } else {
      skip_rest(head);
      cut_.rest += text_.substr(begin, at() - begin);
    }
  }

 private:
  std::size_t at() const { return text_.size() - left_.size(); }

  void keep_member() {
    keep();
    --cut_.values;  // names are not counted
    keep();
  }

  List::Starts starts_in(const CborHead& head) {
    List::Starts starts;
    take_each(left_, head, [&] {
      starts.push_back(static_cast<std::uint32_t>(at()));  // the text is at most a few MB
      skip();
    });
    if (starts.empty()) return starts;
    starts.push_back(static_cast<std::uint32_t>(at() - (head.indefinite() ? 1 : 0)));
    return starts;
  }

  void skip() { skip_rest(take_head(left_)); }

  void skip_rest(const CborHead& head) {
    switch (head.major()) {
      case Major::Bytes:
      case Major::Text:
        if (head.indefinite()) return take_each(left_, head, [this] { skip(); });
        left_.remove_prefix(head.argument());
        return;
      case Major::Array:
        return take_each(left_, head, [this] { skip(); });
      case Major::Map:
        return take_each(left_, head, [this] { skip(), skip(); });
      case Major::Tag:
        return skip();
      case Major::Unsigned:
      case Major::Negative:
      case Major::Simple:
        return;
    }
  }

  std::string_view text_, left_;
  Cut& cut_;
};

/// Reads well-formed items. BodyDecoder::kDeepest limits the recursion.
class CborReader {
 public:
  explicit CborReader(std::string_view bytes) : left_(bytes) {}
  /// Reads a Cut of `whole`, whose arrays stay text.
  CborReader(Cut& cut, const SharedText& whole)
      : left_(cut.rest), arrays_(std::move(cut.arrays)), whole_(whole) {}

  Value value() {
    const CborHead head = take_head(left_);
    switch (head.major()) {
      case Major::Unsigned:
        return integer_value(head.argument());
      case Major::Negative:
        return negative(head.argument());
      case Major::Bytes: {
        const std::string bytes = string(head);
        return {Value::Bytes{{bytes.begin(), bytes.end()}}};
      }
      case Major::Text:
        return {string(head)};
      case Major::Array:
        return whole_ != nullptr ? list() : array(head);
      case Major::Map:
        return object(head);
      case Major::Tag:
        value();  // null, from CborSplitter
        return {Value::TaggedValue{head.argument()}};
      case Major::Simple:
        break;
    }
    return simple(head);
  }

 private:
  void append(std::string& text, const CborHead& head) {
    text += left_.substr(0, head.argument());
    left_.remove_prefix(head.argument());
  }

  std::string string(const CborHead& head) {
    std::string text;
    if (!head.indefinite()) {
      append(text, head);
    } else {
      take_each(left_, head, [&] { append(text, take_head(left_)); });
    }
    return text;
  }

  /// `add` reads one element or pair.
  template <class Items, class Add>
  Value read_items(const CborHead& head, const Add& add) {
    Items items;
    if (!head.indefinite()) items.reserve(head.argument());  // each has at least one byte
    take_each(left_, head, [&] { add(items); });
    return {std::move(items)};
  }

  /// The array that was cut here.
  Value list() {
    icd::require(next_ < arrays_.size());
    return {std::make_shared<const List>(whole_, std::move(arrays_[next_++]), kCborLists)};
  }

  Value array(const CborHead& head) {
    return read_items<Value::Array>(head, [this](Value::Array& array) { array.push_back(value()); });
  }

  Value object(const CborHead& head) {
    return read_items<Value::Object>(head, [this](Value::Object& object) {
      auto name = name_of(value());
      Value member = value();
      if (name) object.emplace_back(*std::move(name), std::move(member));
    });
  }

  /// A member's name: a text, or a byte string of UTF-8, as Python 2 writes it. std::nullopt for other keys.
  static std::optional<std::string> name_of(Value key) {
    if (auto* text = std::get_if<std::string>(&key.is)) return std::move(*text);
    const auto* bytes = std::get_if<Value::Bytes>(&key.is);
    if (bytes == nullptr) return std::nullopt;
    std::string name(bytes->bytes.begin(), bytes->bytes.end());
    return is_utf8(name) ? std::optional(std::move(name)) : std::nullopt;
  }

  std::string_view left_;
  std::vector<List::Starts> arrays_;
  std::size_t next_ = 0;
  SharedText whole_;  // null: no array was cut
};

std::optional<double> real_of(const CborHead& head) {
  if (head.major() == Major::Unsigned) return static_cast<double>(head.argument());
  if (head.major() == Major::Negative) return -1.0 - static_cast<double>(head.argument());
  constexpr std::uint8_t kHalf = 25, kDouble = 27;
  if (head.major() != Major::Simple || head.info() < kHalf || head.info() > kDouble) return std::nullopt;
  return head.number();
}

/// List::reals() for well-formed bytes.
bool reals_in(std::string_view object, std::span<const std::string_view> names, std::span<double> into) {
  if (const CborHead map = take_head(object); map.major() != Major::Map || map.argument() != names.size())
    return false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const CborHead name = take_head(object);
    if (name.major() != Major::Text || name.argument() != names[i].size() || !object.starts_with(names[i]))
      return false;
    object.remove_prefix(names[i].size());
    const auto number = real_of(take_head(object));
    if (!number || !std::isfinite(*number)) return false;
    into[i] = *number;
  }
  return object.empty();
}

/// The value at `begin`.
icd::Checked<Value> parse_with_lists(const SharedText& text, std::size_t begin, std::size_t /*end*/) {
  Cut cut;
  CborCutter(*text, begin, cut).keep();
  if (cut.values > kMostOutsideLists) return std::unexpected(too_many_outside_lists(kMostOutsideLists));
  return CborReader(cut, text).value();
}

}  // namespace

Value cbor_value(std::string_view bytes) {
  return CborReader(bytes).value();
}

icd::Checked<Value> cbor_value_with_lists(std::string bytes) {
  return parse_with_lists(std::make_shared<const std::string>(std::move(bytes)), 0, 0);
}

}  // namespace adit::codec
