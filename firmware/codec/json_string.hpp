#pragma once

#include <cstddef>
#include <expected>
#include <string>
#include <string_view>

#include "codec/utf8.hpp"

namespace adit::codec {

/// What is wrong with a text, and at which byte of what was given.
struct Fault {
  std::size_t at = 0;
  std::string what;
};

/// The inside of one JSON string (RFC 8259 section 7), from after its first quotation mark to its last, given
/// in pieces of any size. Stricter than the RFC in one thing that it leaves open: a surrogate must have its
/// partner.
class JsonString {
 public:
  struct Piece {
    std::size_t taken = 0;  // bytes used up of what was given
    std::string_view raw;   // characters as they stand in the document...
    std::string_view text;  // ...and what they mean, in UTF-8
    bool ended = false;     // the closing quotation mark followed, and was taken
  };

  /// The next run of characters, or the next escape. Requires !in.empty(). The views live until the next
  /// call.
  std::expected<Piece, Fault> next(std::string_view in);
  /// Neither within an escape nor within a character: what comes next stands for itself if it is plain ASCII.
  bool between_characters() const { return escape_.empty() && utf8_.complete(); }

 private:
  std::expected<Piece, Fault> plain(std::string_view in);
  std::expected<Piece, Fault> escape(std::string_view in);
  /// Whether the escape is whole with `c`.
  std::expected<bool, const char*> escape_ends_with(char c);
  std::expected<bool, const char*> unicode_escape_ends();

  Utf8Checker utf8_;
  std::string escape_;    // as far as it has come; empty: not in an escape
  std::string finished_;  // the last whole escape...
  std::string meaning_;   // ...and its character
};

}  // namespace adit::codec
