#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "icd/status.hpp"
#include "intake/head.hpp"

namespace adit::intake {

/// How the end of a request's body is found (RFC 9112 6).
struct Framing {
  bool has_body = false;
  std::optional<std::uint64_t> length = 0;  // absent if chunked
  bool is_version_1_0 = false;              // the connection then ends with the answer (RFC 9112 9.3)
};

/// Checks the head of one request before libmicrohttpd reads it, because libmicrohttpd accepts more than RFC
/// 9112 allows. Refuses heads that two readers could read in two ways. Keeps no bytes, and reads each byte a
/// fixed number of times even if the head arrives in many pieces.
class HeadChecker {
 public:
  static constexpr std::size_t kMostBytes = 16 * 1024;  // of the head, with the blank line after it
  static constexpr std::size_t kMostParts = 128;        // fields, query parameters and cookies
  static constexpr std::size_t kMostCookieBytes = 4096;

  enum class Verdict : std::uint8_t { More, Whole, Refused };

  /// `so_far`: all bytes of the head that have arrived, the earlier ones included. More: the head is not
  /// whole. Ignores bytes after a whole head.
  Verdict check(std::string_view so_far);

  /// For Whole: the bytes of the head, and how its body ends.
  std::size_t size() const { return looked_at_; }
  const Framing& framing() const { return framing_; }
  /// For Refused: 400, 431 or 505.
  const icd::Refusal& refusal() const { return refusal_; }
  bool is_head_method() const { return is_head_method_; }
  bool names_icd_uri() const { return names_icd_uri_; }

 private:
  /// A part of the head as an offset, because the bytes may have moved at the next call.
  struct Place {
    std::size_t at = 0, size = 0;
  };
  static Place place_of(std::string_view so_far, std::string_view part);

  void line(std::string_view so_far, std::string_view line);
  void request_line(std::string_view so_far, std::string_view line);
  void target(std::string_view so_far, std::string_view method, std::string_view target);
  void field(std::string_view so_far, std::string_view line);
  void check_single(std::string_view so_far, const FieldLine& field);
  void host(std::string_view so_far, std::string_view value);
  void content_length(std::string_view value);
  void transfer_encoding(std::string_view value);
  void cookie(std::string_view value);
  void end(std::string_view so_far);
  void count(std::size_t parts);
  void refuse(std::string_view sentence, icd::Status status = icd::Status::BadRequest);

  Verdict verdict_ = Verdict::More;
  icd::Refusal refusal_;
  std::size_t looked_at_ = 0;   // bytes
  std::size_t line_begin_ = 0;  // offset
  bool request_line_came_ = false;
  bool is_version_1_0_ = false;
  bool is_head_method_ = false;
  bool names_icd_uri_ = false;
  std::optional<Place> authority_;  // of a target in absolute form
  std::optional<Place> host_;
  std::array<std::optional<Place>, 4> single_;  // values of the fields that may occur once
  bool has_length_ = false, has_coding_ = false;
  std::size_t parts_ = 0, cookie_bytes_ = 0;
  Framing framing_;
};

}  // namespace adit::intake
