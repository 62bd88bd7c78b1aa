#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "uplink/connection.hpp"

namespace adit::uplink {

/// Parses "Sun, 06 Nov 1994 08:49:37 GMT" (IMF-fixdate, RFC 9110 5.6.7). nullopt if `text` is no such date.
/// Does not check the name of the day.
std::optional<std::chrono::sys_seconds> http_date(const std::string& text);

/// Parses an HTTP/1 answer to one request as its bytes arrive (RFC 9112). Skips interim answers (1xx).
///
/// Memory is bounded whatever lengths the peer announces: only received bytes are held, at most
/// `longest_body` of the body, kLongestHead of each head, and kMostBytes() in all.
class AnswerParser {
 public:
  enum class State : std::uint8_t { Incomplete, Whole, Malformed };
  static constexpr std::size_t kLongestHead = 16 * 1024;  // bytes

  /// `longest_body`: bytes. A longer body is Malformed as soon as its length is known.
  explicit AnswerParser(std::size_t longest_body);
  ~AnswerParser();

  /// Requires that no earlier call returned Whole or Malformed.
  State feed(std::string_view bytes);
  /// The peer has closed its direction. This ends an answer without a length (RFC 9112 6.3).
  State feed_end();

  /// The status; 0 until the head has arrived.
  int status() const;
  /// Returns and removes the body received since the last call, for an endless answer. take() does not return
  /// these bytes, and all limits start again.
  std::string take_part();

  /// For Whole, before take(): the field Location, or "".
  std::string location() const;
  /// For Whole. A body with a Content-Encoding is decoded, if that takes at most `longest_body`.
  Answered take();
  /// For Whole: both sides allow reuse of the connection, and no bytes followed the answer.
  bool may_keep_alive() const;
  /// For Malformed: the status if the only fault is the length; else 0.
  int too_long_status() const;
  /// For Malformed: a sentence on the fault.
  const std::string& fault() const;
  bool has_begun() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::uplink
