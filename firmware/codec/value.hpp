#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace adit::codec {

class List;

/// A parsed document without its bulk data: what JSON (RFC 8259) and CBOR (RFC 8949) have in common.
/// Members keep their order and their duplicates, so that a reader can refuse a member that is given twice.
struct Value {
  struct Bytes {  // a CBOR byte string; text where it is UTF-8 and text is asked for
    std::vector<std::uint8_t> bytes;
    friend bool operator==(const Bytes&, const Bytes&) = default;
  };
  /// Replaces a value under a CBOR tag that changes the value's meaning. If a member is not read, its tag
  /// refuses nothing.
  struct UnderTag {
    std::uint64_t tag = 0;
    friend bool operator==(UnderTag, UnderTag) = default;
  };
  /// Stands where the map's `data` was split out (Document::data holds it).
  struct SplitOut {
    friend bool operator==(SplitOut, SplitOut) = default;
  };
  using Array = std::vector<Value>;
  using Member = std::pair<std::string, Value>;  // CBOR keys that are no text are left out
  using Object = std::vector<Member>;

  std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string, Bytes, UnderTag,
               SplitOut, Array, Object,
               std::shared_ptr<const List>>  // an array, where it is left as text (Split::Lists)
      is = nullptr;

  /// "a string", "a whole number", "null", ...: for sentences.
  std::string kind() const;

  /// The same kind, and the same value; lists that are left as text only where they are one.
  friend bool operator==(const Value& one, const Value& other);
};

}  // namespace adit::codec
