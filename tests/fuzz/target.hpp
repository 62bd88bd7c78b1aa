#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <expected>
#include <source_location>
#include <span>
#include <string>
#include <string_view>

#include "codec/row.hpp"

namespace adit::fuzz {

/// Anybody's bytes.
using Input = std::string_view;

/// A law that is broken ends the program, as a sanitizer does.
inline void require(bool law, const std::source_location& where = std::source_location::current()) {
  if (law) return;
  std::fprintf(stderr, "a law is broken: %s:%u\n", where.file_name(), static_cast<unsigned>(where.line()));
  std::abort();
}

inline std::span<const std::uint8_t> bytes_of(Input text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Takes the input's last byte away, which says how large the pieces are in which the rest arrives. (Behind,
/// so that a seed is a plain file with a line end.)
inline std::size_t take_piece(Input& input) {
  if (input.empty()) return 1;
  const std::size_t piece = 1U + static_cast<unsigned char>(input.back()) % 64U;
  input.remove_suffix(1);
  return piece;
}

/// Until `feed` returns false.
template <class Feed>
void in_pieces(Input text, std::size_t piece, Feed feed) {
  for (; !text.empty() && feed(text.substr(0, piece)); text.remove_prefix(std::min(piece, text.size()))) {
  }
}

/// The law of what Adit keeps in files: what is refused has a sentence; what is read, written and read again
/// stays as it is. `read` gives an expected of a text's meaning or a sentence, `write` a text.
template <class Read, class Write>
void settles(Input text, Read read, Write write) {
  const auto kept = read(text);
  if (!kept) return require(!kept.error().empty());
  const std::string written = write(*kept);
  const auto again = read(written);
  require(again.has_value() && write(*again) == written);
}

/// The same of a row file (codec/row.hpp).
template <class Message>
void settles(Input text, std::expected<Message, std::string> (*read)(std::string_view)) {
  settles(text, read, [](const Message& message) { return codec::write_file(message); });
}

}  // namespace adit::fuzz
