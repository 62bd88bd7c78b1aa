#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>

#include "codec/base64.hpp"
#include "codec/bulk_data.hpp"
#include "codec/data_path.hpp"
#include "codec/json_number.hpp"
#include "codec/splitter.hpp"
#include "codec/utf8.hpp"

namespace adit::codec {

/// An error in a text, and its byte.
struct Fault {
  std::size_t at = 0;
  std::string what;
};

/// The inside of a JSON string (RFC 8259 section 7), from its first quotation mark to its last, read in
/// pieces of any size. Stricter than the RFC in one point: a surrogate must be part of a pair.
class JsonString {
 public:
  struct Piece {
    std::size_t taken = 0;  // bytes read
    std::string_view raw;   // characters in the document
    std::string_view text;  // the same in UTF-8
    bool ended = false;     // the closing quotation mark was read
  };

  /// The next run of characters, or escape. Requires !in.empty(). The views are valid until the next call.
  std::expected<Piece, Fault> next(std::string_view in);
  /// Whether it is outside escapes and characters, so that plain ASCII stands for itself.
  bool is_between_characters() const { return escape_.empty() && utf8_.complete(); }

 private:
  std::expected<Piece, Fault> plain(std::string_view in);
  std::expected<Piece, Fault> escape(std::string_view in);
  /// Whether `c` completes the escape.
  std::expected<bool, const char*> feed_escape(char c);
  std::expected<bool, const char*> finish_unicode_escape();

  Utf8Checker utf8_;
  std::string escape_;    // the present escape so far; empty: none
  std::string finished_;  // the last whole escape
  std::string meaning_;   // its character
};

/// Reads JSON (RFC 8259) as a pushdown automaton. A leading byte order mark is ignored (8.1). Without split
/// data, a document in one piece is read by json_value(). The automaton reads all others from their first
/// piece, and refuses them at the first error.
class JsonSplitter final : public Splitter {
 public:
  /// `data` must outlive this object.
  JsonSplitter(Split split, DocumentLimits most, BulkData& data);

  icd::Checked<void> feed(std::string_view bytes) override;
  icd::Checked<Value> finish() override;

 private:
  enum class Expect : std::uint8_t { Value, FirstElement, FirstKey, Key, Colon, Separator };
  enum class Token : std::uint8_t { None, Key, String, Number, Literal };
  enum class Diversion : std::uint8_t { No, Base64, Elements };
  /// The first piece, if it is a whole document so far.
  struct WholeDocument {
    SharedText text;
    Value root;
  };
  struct Number {
    JsonNumber grammar;
    std::string text;
    std::size_t at = 0;
  };

  icd::Checked<void> read(std::string_view bytes);
  /// Call after the last feed. Error: the document is incomplete.
  icd::Checked<void> end();

  /// These functions read a part of `in` (not empty) and return its length.
  icd::Checked<std::size_t> step(std::string_view in);
  icd::Checked<std::size_t> structure(std::string_view in);
  icd::Checked<std::size_t> value(char first);
  icd::Checked<std::size_t> separator(char c);
  icd::Checked<std::size_t> string(std::string_view in);
  icd::Checked<std::size_t> number(std::string_view in);
  icd::Checked<std::size_t> literal(std::string_view in);

  icd::Checked<std::size_t> open(char bracket);
  icd::Checked<std::size_t> close(char bracket);
  icd::Checked<std::size_t> begin_literal(std::string_view word);
  icd::Checked<void> divert(char first);
  icd::Checked<void> decode(std::string_view base64);
  icd::Checked<std::size_t> base64_groups(std::string_view in);
  icd::Checked<std::size_t> plain_elements(std::string_view in);
  icd::Checked<void> finish_string();
  icd::Checked<void> finish_number(std::optional<char> next);
  icd::Checked<void> keep_number();
  icd::Checked<void> divert_number();
  void end_value();
  void keep(std::string_view raw) {
    if (diverted_ == Diversion::No) rest_.add(raw);
  }
  bool is_in_object() const { return path_.depth() > 0 && objects_[path_.depth() - 1]; }

  icd::Refusal fault(std::string_view what) const { return fault_at(at_, what); }
  static icd::Refusal fault_at(std::size_t at, std::string_view what);
  icd::Refusal mismatch(std::string_view what, char got) const;

  const Split split_;
  BulkData& data_;
  DataPath path_;

  std::optional<WholeDocument> whole_;

  Expect expect_ = Expect::Value;
  Token token_ = Token::None;
  Diversion diverted_ = Diversion::No;
  std::bitset<BodyDecoder::kDeepest> objects_;  // open brackets that are braces
  std::size_t at_ = 0;                          // bytes read so far
  std::size_t mark_ = 0;                        // size of the byte order mark

  JsonString string_;
  Number number_;
  std::string_view word_;  // rest of a literal
  Base64Decoder base64_;

  KeptText rest_;  // without white space; the map's data is null
};

}  // namespace adit::codec
