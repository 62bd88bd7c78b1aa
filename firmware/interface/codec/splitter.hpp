#pragma once

#include <cstddef>
#include <limits>
#include <string_view>

#include "codec/value.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// Limits of a document without the map's data.
struct Most {
  std::size_t text = 0;                                          // bytes
  std::size_t values = std::numeric_limits<std::size_t>::max();  // with pieces of strings, without names
};

/// Checks a document on arrival, passes the map's data to a BulkData, and stores the rest for parsing. One
/// class for each format.
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

/// 422: the value at "msg.data" cannot be decoded.
icd::Refusal bad_data(std::string_view why);
/// 413: the rest exceeds `most` bytes or values.
icd::Refusal text_too_large(std::size_t most);
icd::Refusal too_many_values(std::size_t most);
icd::Refusal too_many_outside_lists(std::size_t most);

/// Replaces the splitter's null at "msg.data" by SplitOut.
void mark_split_out(Value& root);

}  // namespace adit::codec
