#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "uplink/connection.hpp"

namespace adit::uplink {

/// The bytes of an HTTP/1 answer to one request, as they come (RFC 9112). Interim answers (1xx) are skipped.
class AnswerParser {
 public:
  enum class State : std::uint8_t { Incomplete, Whole, Malformed };

  AnswerParser();
  AnswerParser(AnswerParser&&) noexcept;
  AnswerParser& operator=(AnswerParser&&) noexcept;
  ~AnswerParser();

  /// Requires that no call before said Whole or Malformed.
  State feed(std::string_view bytes);
  /// The peer has sent all that it will, which is the end of an answer that has no length (RFC 9112 6.3).
  State feed_end();

  /// For Whole.
  Answered take();
  /// For Whole: both sides may go on using the connection, and nothing came after the answer.
  bool may_keep_alive() const;
  /// For Malformed: what is wrong with it, in words of our own.
  const std::string& fault() const;
  bool has_begun() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::uplink
