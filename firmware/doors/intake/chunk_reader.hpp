#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace adit::intake {

/// Parses a chunked body (RFC 9112 7.1) as it arrives. Skips extensions and trailers. Refuses each deviation
/// from the grammar, such as a bare LF or extra blanks.
class ChunkReader {
 public:
  enum class State : std::uint8_t { More, Whole, Refused };
  static constexpr std::size_t kMostLine = 4096;           // bytes of a size line with its extensions
  static constexpr std::size_t kMostTrailers = 16 * 1024;  // bytes

  /// Parses `bytes` and appends the bytes of the body to `data`. Ignores bytes after the end of the body.
  State feed(std::string_view bytes, std::string& data);
  State state() const { return state_; }
  /// For Refused: a sentence.
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
  std::uint64_t left_ = 0;  // bytes of the chunk that have not arrived
  std::string line_;        // the part of the line that has arrived
  std::size_t trailers_ = 0;
  std::string_view trouble_;
};

}  // namespace adit::intake
