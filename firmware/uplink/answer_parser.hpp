#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "uplink/connection.hpp"

namespace adit::uplink {

/// The bytes of an HTTP/1 answer to one request, as they come (RFC 9112). Interim answers (1xx) are skipped.
///
/// Nothing that the peer says makes it take memory: it holds what has come, and that is bounded (its body by
/// `longest_body`, each head by kLongestHead, all of it by kMostBytes()), whatever lengths are announced.
class AnswerParser {
 public:
  enum class State : std::uint8_t { Incomplete, Whole, Malformed };
  static constexpr std::size_t kLongestHead = 16 * 1024;  // bytes

  /// `longest_body`: bytes; a longer one is Malformed, as soon as that is known.
  explicit AnswerParser(std::size_t longest_body);
  ~AnswerParser();

  /// Requires that no call before said Whole or Malformed.
  State feed(std::string_view bytes);
  /// The peer has sent all that it will, which is the end of an answer that has no length (RFC 9112 6.3).
  State feed_end();

  /// Once the head has come; before, 0.
  int status() const;
  /// What has come of the body since the last call, for an answer that goes on: it is not in take(), and all
  /// limits are of what comes from now on.
  std::string take_part();

  /// For Whole, before take(): the field Location, or "".
  std::string location() const;
  /// For Whole.
  Answered take();
  /// For Whole: both sides may go on using the connection, and nothing came after the answer.
  bool may_keep_alive() const;
  /// For Malformed: its status where all that is wrong is that it is too long; else 0.
  int too_long_status() const;
  /// For Malformed: what is wrong with it, in words of our own.
  const std::string& fault() const;
  bool has_begun() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::uplink
