#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "codec/value.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// Limits of a document without the map's data.
struct DocumentLimits {
  std::size_t text = 0;                                          // bytes
  std::size_t values = std::numeric_limits<std::size_t>::max();  // with pieces of strings, without names
  std::string_view but = "";                                     // " without msg.data", for a sentence
};

/// Checks a document of one format on arrival, passes the map's data to a BulkData, and stores the rest.
class Splitter {
 public:
  Splitter() = default;
  virtual ~Splitter() = default;
  Splitter(const Splitter&) = delete;
  Splitter& operator=(const Splitter&) = delete;

  virtual icd::Checked<void> feed(std::string_view bytes) = 0;
  /// The rest, with SplitOut at "msg.data" if data was split off.
  virtual icd::Checked<Value> finish() = 0;
};

/// The document without the map's data, within its limits.
class KeptText {
 public:
  explicit KeptText(DocumentLimits most) : most_(most) {}

  const DocumentLimits& most() const { return most_; }
  void add(std::string_view raw) { text_ += raw; }
  void reserve(std::size_t bytes) { text_.reserve(bytes); }
  /// Counts a value. False: too_many_values().
  bool count() { return ++values_ <= most_.values; }
  /// Whether the text may have `more` bytes. False: too_large().
  bool fits(std::size_t more = 0) const { return text_.size() + more <= most_.text; }
  /// 413.
  icd::Refusal too_many_values() const;
  icd::Refusal too_large() const;
  std::size_t values() const { return values_; }
  const std::string& text() const { return text_; }
  std::string take_text() { return std::move(text_); }

 private:
  const DocumentLimits most_;
  std::size_t values_ = 0;
  std::string text_;
};

/// 422: the value at "msg.data" cannot be decoded.
icd::Refusal bad_data(std::string_view why);
/// 413.
icd::Refusal too_many_outside_lists(std::size_t most);

/// Replaces the splitter's null at "msg.data" by SplitOut.
void mark_split_out(Value& root);

/// Equal elements in sequence.
struct PlainElements {
  std::uint8_t value = 0;  // 255 for -1
  std::size_t count = 0;
};

/// Removes elements and their commas from the start of a JSON array in `text`: integers from 0 to 255 or -1,
/// with white space. Takes equal texts together, because a map's cells mostly equal their neighbours.
/// std::nullopt, with `text` unchanged: no such element with a comma; use the general reader.
std::optional<PlainElements> take_plain_elements(std::string_view& text);

/// The same for a CBOR array: elements of one or two bytes, 0 to 255 or -1 (RFC 8949 3.1). Requires most > 0.
std::optional<PlainElements> take_plain_cbor_elements(std::string_view& bytes, std::uint64_t most);

}  // namespace adit::codec
