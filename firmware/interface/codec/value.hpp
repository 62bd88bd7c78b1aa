#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "icd/status.hpp"

namespace adit::codec {

class List;

/// A parsed document without its bulk data, for JSON (RFC 8259) and CBOR (RFC 8949). Members keep their order
/// and duplicates, so that a reader can refuse a repeated member.
struct Value {
  struct Bytes {  // a CBOR byte string; accepted as text if it is UTF-8
    std::vector<std::uint8_t> bytes;
    friend bool operator==(const Bytes&, const Bytes&) = default;
  };
  /// Replaces a value under a CBOR tag that changes its meaning: an error only if the member is read.
  struct TaggedValue {
    std::uint64_t tag = 0;
    friend bool operator==(TaggedValue, TaggedValue) = default;
  };
  /// Replaces the map's `data`, which is in Document::data.
  struct SplitOut {
    friend bool operator==(SplitOut, SplitOut) = default;
  };
  using Array = std::vector<Value>;
  using Member = std::pair<std::string, Value>;  // CBOR keys that are not text are left out
  using Object = std::vector<Member>;

  std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string, Bytes, TaggedValue,
               SplitOut, Array, Object,
               std::shared_ptr<const List>>  // an array left as text (Split::Lists)
      is = nullptr;

  /// "a string", "a whole number", "null", ...: for sentences.
  std::string kind() const;

  /// Equal kinds and values. Lists left as text are equal only if they are the same object.
  friend bool operator==(const Value& one, const Value& other);
};

/// The first member of that name, or null.
template <class Object>  // Value::Object, const or not
auto* find_member(Object& object, std::string_view name) {
  const auto found = std::ranges::find(object, name, &Value::Member::first);
  return found == object.end() ? nullptr : &found->second;
}

using SharedText = std::shared_ptr<const std::string>;

/// An array left as text, so that a large message is never a tree in memory. Elements are parsed on request.
class List {
 public:
  /// Start of each element in the text, then the start of a next one. Empty for an empty array.
  using Starts = std::vector<std::uint32_t>;
  struct Format {
    icd::Checked<Value> (*element)(const SharedText& text, std::size_t begin, std::size_t end);
    bool (*reals)(std::string_view element, std::span<const std::string_view> names, std::span<double> into);
    std::size_t gap;  // bytes between elements
  };

  /// `format` must outlive it.
  List(SharedText text, Starts starts, const Format& format)
      : text_(std::move(text)), starts_(std::move(starts)), format_(format) {}

  std::size_t size() const { return starts_.empty() ? 0 : starts_.size() - 1; }
  /// `index` must be below size(). Error 413: more than kMostOutsideLists values outside its own lists.
  icd::Checked<Value> element(std::size_t index) const;
  /// Reads an element that is an object of exactly these members, in this order, with finite numbers. False:
  /// another element, which element() then describes. Reads points and colors at a fifth of the cost.
  bool reals(std::size_t index, std::span<const std::string_view> names, std::span<double> into) const;

 private:
  std::size_t end_of(std::size_t index) const { return starts_[index + 1] - format_.gap; }

  const SharedText text_;
  const Starts starts_;
  const Format& format_;
};

inline constexpr std::size_t kMostOutsideLists = 20'000;  // values of a document, or of a list's element

}  // namespace adit::codec
