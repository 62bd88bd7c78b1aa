#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

namespace adit::icd {

/// HTTP status codes: those of the ICD's section 4.1, and some more of HTTP (RFC 9110).
enum class Status : std::uint16_t {
  Ok = 200,
  Created = 201,
  NoContent = 204,
  BadRequest = 400,
  Unauthorized = 401,
  Forbidden = 403,
  NotFound = 404,
  MethodNotAllowed = 405,
  RequestTimeout = 408,
  Conflict = 409,
  LengthRequired = 411,
  ContentTooLarge = 413,
  UnprocessableEntity = 422,
  TooManyRequests = 429,
  InternalServerError = 500,
  BadGateway = 502,
  ServiceUnavailable = 503,
  GatewayTimeout = 504,
};

/// Why a message is rejected: the status for the sender, and a sentence. The sentence names the field by its
/// path, the expected and the actual value ("msg.info.width: expected a whole number, got a string").
struct Refusal {
  Status status = Status::UnprocessableEntity;
  std::string sentence;
  std::size_t parts = 0;  // number of rejected poses or markers; 0: it is about the message
  /// The key of the setting that can prevent this refusal ("rules.map_bytes"), a literal; "": there is none.
  std::string_view setting = {};
  friend bool operator==(const Refusal&, const Refusal&) = default;
};

template <class T>
using Checked = std::expected<T, Refusal>;

inline constexpr int kTooManyRequests = static_cast<int>(Status::TooManyRequests);

/// A status of the endpoint or the token rather than of the message: other messages would get it, too.
constexpr bool concerns_all_messages(int status) {
  return status == 401 || status == 403 || status == 404 || status == 405 || status == 407;
}

/// A 2xx answer (RFC 9110 15.3).
constexpr bool is_success(int status) {
  return status >= 200 && status < 300;
}

}  // namespace adit::icd
