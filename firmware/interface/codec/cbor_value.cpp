#include "codec/cbor_value.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "codec/cbor.hpp"
#include "codec/splitter.hpp"
#include "codec/utf8.hpp"

namespace adit::codec {
namespace {

Value negative(std::uint64_t argument) {  // RFC 8949 3.1: the value is -1 - argument
  if (argument <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
    return {-1 - static_cast<std::int64_t>(argument)};
  }
  return {-1.0 - static_cast<double>(argument)};
}

Value whole(std::uint64_t number) {
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

/// Reads well-formed items. BodyDecoder::kDeepest limits the recursion.
class CborReader {
 public:
  CborReader(std::string_view bytes, Lists* lists) : left_(bytes), lists_(lists) {}

  Value value() {
    const CborHead head = next_head();
    switch (head.major()) {
      case Major::Unsigned:
        return whole(head.argument());
      case Major::Negative:
        return negative(head.argument());
      case Major::Bytes: {
        const std::string bytes = string(head);
        return {Value::Bytes{{bytes.begin(), bytes.end()}}};
      }
      case Major::Text:
        return {string(head)};
      case Major::Array:
        return lists_ != nullptr ? lists_->next() : array(head);  // arrays in a Cut are empty
      case Major::Map:
        return object(head);
      case Major::Tag:
        value();  // null, from CborSplitter
        return {Value::UnderTag{head.argument()}};
      case Major::Simple:
        break;
    }
    return simple(head);
  }

 private:
  CborHead next_head() {
    CborHead head;
    left_.remove_prefix(head.next(left_));
    return head;
  }

  bool take_break() {
    if (left_[0] != '\xFF') return false;
    left_.remove_prefix(1);
    return true;
  }

  void append(std::string& text, const CborHead& head) {
    text += left_.substr(0, head.argument());
    left_.remove_prefix(head.argument());
  }

  std::string string(const CborHead& head) {
    std::string text;
    if (!head.indefinite()) {
      append(text, head);
    } else {
      while (!take_break()) append(text, next_head());
    }
    return text;
  }

  /// `add` reads one element or pair.
  template <class Items, class Add>
  Value filled(const CborHead& head, const Add& add) {
    Items items;
    if (!head.indefinite()) {
      items.reserve(head.argument());  // each has at least one byte
      for (std::uint64_t left = head.argument(); left > 0; --left) add(items);
    } else {
      while (!take_break()) add(items);
    }
    return {std::move(items)};
  }

  Value array(const CborHead& head) {
    return filled<Value::Array>(head, [this](Value::Array& array) { array.push_back(value()); });
  }

  Value object(const CborHead& head) {
    return filled<Value::Object>(head, [this](Value::Object& object) {
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
  Lists* lists_;
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
  const auto next = [&] {
    CborHead head;
    object.remove_prefix(head.next(object));
    return head;
  };
  if (const CborHead map = next(); map.major() != Major::Map || map.argument() != names.size()) return false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const CborHead name = next();
    if (name.major() != Major::Text || name.argument() != names[i].size() || !object.starts_with(names[i]))
      return false;
    object.remove_prefix(names[i].size());
    const auto number = real_of(next());
    if (!number || !std::isfinite(*number)) return false;
    into[i] = *number;
  }
  return object.empty();
}

icd::Checked<Value> with_lists_at(const SharedText& text, std::size_t begin, std::size_t end);
constexpr ListFormat kCborLists = {.element = with_lists_at, .reals = reals_in, .gap = 0};

/// The value at `begin`.
icd::Checked<Value> with_lists_at(const SharedText& text, std::size_t begin, std::size_t /*end*/) {
  Cut cut = cut_cbor(*text, begin);
  if (cut.values > kMostOutsideLists) return std::unexpected(too_many_outside_lists(kMostOutsideLists));
  Lists lists(text, std::move(cut.arrays), kCborLists);
  return CborReader(cut.rest, &lists).value();
}

}  // namespace

Value cbor_value(std::string_view bytes) {
  return CborReader(bytes, nullptr).value();
}

icd::Checked<Value> cbor_value_with_lists(std::string bytes) {
  return with_lists_at(std::make_shared<const std::string>(std::move(bytes)), 0, 0);
}

}  // namespace adit::codec
