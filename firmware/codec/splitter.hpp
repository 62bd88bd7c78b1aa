#pragma once

#include <cstddef>
#include <limits>
#include <string_view>

#include "codec/value.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// What is kept of a document, but for the map's data, at most.
struct Most {
  std::size_t text = 0;                                          // bytes
  std::size_t values = std::numeric_limits<std::size_t>::max();  // and pieces of strings; names not counted
};

/// Checks that a document is well-formed as it arrives, gives the map's data to a BulkData, and keeps the
/// rest until it can be parsed whole. One for each format.
class Splitter {
 public:
  Splitter() = default;
  virtual ~Splitter() = default;
  Splitter(const Splitter&) = delete;
  Splitter& operator=(const Splitter&) = delete;

  virtual icd::Checked<void> feed(std::string_view bytes) = 0;
  /// The rest; SplitOut stands at "msg.data" if data was split.
  virtual icd::Checked<Value> finish() = 0;
};

/// 422: what stands at "msg.data" cannot be decoded.
icd::Refusal bad_data(std::string_view why);
/// 413: the rest is over `most` bytes, or values.
icd::Refusal text_too_large(std::size_t most);
icd::Refusal too_many_values(std::size_t most);
icd::Refusal too_many_outside_lists(std::size_t most);

/// Puts SplitOut at "msg.data", where the splitter left a null.
void mark_split_out(Value& root);

}  // namespace adit::codec
