#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace adit::intake {

/// Reads a chunked body (RFC 9112 7.1) as it comes. Extensions and trailers are read over; what is not just
/// as the grammar has it is refused, bare LF and blanks among it.
class ChunkReader {
 public:
  enum class State : std::uint8_t { More, Whole, Refused };
  static constexpr std::size_t kMostLine = 4096;           // bytes of a chunk's size with its extensions
  static constexpr std::size_t kMostTrailers = 16 * 1024;  // bytes

  /// Goes on with `bytes`, and appends what is the body's own to `data`. What follows a whole body is not
  /// looked at.
  State feed(std::string_view bytes, std::string& data);
  State state() const { return state_; }
  /// Once refused: a sentence.
  std::string_view trouble() const { return trouble_; }

 private:
  enum class In : std::uint8_t { Size, Data, AfterData, Trailers };

  std::size_t take_data(std::string_view bytes, std::string& data);
  std::size_t take_line(std::string_view bytes);
  void whole_line();
  void size_line();
  void trailer_line();
  void refuse(std::string_view trouble);

  State state_ = State::More;
  In in_ = In::Size;
  std::uint64_t left_ = 0;  // of the chunk, bytes
  std::string line_;        // so far
  std::size_t trailers_ = 0;
  std::string_view trouble_;
};

}  // namespace adit::intake
