#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "codec/bulk_data.hpp"
#include "codec/cbor.hpp"
#include "codec/data_path.hpp"
#include "codec/splitter.hpp"
#include "codec/utf8.hpp"

namespace adit::codec {

/// Checks that CBOR (RFC 8949) is well-formed (section 5.3.1), texts are UTF-8, and nesting, with tags, is
/// not too deep. Never trusts a length before its bytes arrive. Drops tags that only annotate their value. A
/// value under another tag becomes TaggedValue.
class CborSplitter final : public Splitter {
 public:
  /// `data` must outlive this object.
  CborSplitter(Split split, DocumentLimits most, BulkData& data);

  icd::Checked<void> feed(std::string_view bytes) override;
  icd::Checked<Value> finish() override;

 private:
  struct Nest {
    Major kind = Major::Array;  // Array, Map or Tag
    bool indefinite = false;
    std::uint64_t left = 0;  // remaining elements or pairs
    bool key_next = false;   // in a Map
  };
  /// Destination of a string's bytes.
  enum class Destination : std::uint8_t { Rest, Key, Data };
  struct String {
    Major kind = Major::Bytes;  // Bytes or Text
    bool chunked = false;       // its length is indefinite
    Destination into = Destination::Rest;
  };

  /// These functions read a part of `in` (not empty) and return its length.
  icd::Checked<std::size_t> head(std::string_view in);
  icd::Checked<std::size_t> string(std::string_view in);

  icd::Checked<void> item();
  icd::Checked<void> count();
  icd::Checked<void> check_head() const;
  icd::Checked<void> begin_string(Destination into);
  icd::Checked<void> chunk_of_string();
  icd::Checked<void> begin_piece();
  icd::Checked<void> end_of_piece();
  void end_string();
  icd::Checked<void> tag();
  icd::Checked<void> nest(Major kind);
  icd::Checked<void> simple();
  icd::Checked<void> end_of_nest();
  void end_item();

  icd::Checked<void> divert();
  icd::Checked<void> element();
  icd::Checked<std::size_t> plain_elements(std::string_view in);
  bool elements() const { return elements_of_ > 0; }
  bool leaves_out() const { return left_out_of_ > 0; }
  void keep(std::string_view raw) {
    if (!elements() && !leaves_out()) rest_.add(raw);
  }
  /// The array or map of the next item; null at the top level.
  const Nest* container() const;
  bool is_at_key() const;

  icd::Refusal fault(std::string_view what) const { return fault_at(head_at_, what); }
  static icd::Refusal fault_at(std::size_t at, std::string_view what);

  const Split split_;
  BulkData& data_;
  DataPath path_;

  std::size_t at_ = 0;       // bytes read so far
  std::size_t head_at_ = 0;  // start of the head
  std::vector<Nest> nests_;
  bool whole_ = false;
  CborHead head_;

  std::optional<String> string_;  // the present one
  std::uint64_t piece_left_ = 0;  // bytes before its next head
  Utf8Checker utf8_;

  std::size_t elements_of_ = 0;  // nesting depth of the map's data if it is an array

  std::size_t left_out_of_ = 0;  // nesting depth of the tag whose value is dropped

  /// No annotating tags; the map's data is null; simple values without meaning (RFC 8949 3.3) are undefined.
  KeptText rest_;
};

}  // namespace adit::codec
