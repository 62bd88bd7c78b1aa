#pragma once

#include <cstddef>
#include <expected>
#include <string>
#include <string_view>

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

  /// The next run of characters, or the next escape. Requires !in.empty(). The views are valid until the next
  /// call.
  std::expected<Piece, Fault> next(std::string_view in);
  /// Whether it is outside escapes and characters, so that plain ASCII stands for itself.
  bool between_characters() const { return escape_.empty() && utf8_.complete(); }

 private:
  std::expected<Piece, Fault> plain(std::string_view in);
  std::expected<Piece, Fault> escape(std::string_view in);
  /// Whether `c` completes the escape.
  std::expected<bool, const char*> escape_ends_with(char c);
  std::expected<bool, const char*> unicode_escape_ends();

  Utf8Checker utf8_;
  std::string escape_;    // the present escape so far; empty: none
  std::string finished_;  // the last whole escape
  std::string meaning_;   // its character
};

}  // namespace adit::codec
