#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

namespace adit::icd {

/// HTTP status codes: those of the ICD's section 4.1, and the few that HTTP (RFC 9110) needs beside them.
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

/// Why a message was not taken: the status its sender gets, and a sentence that names the field by its path,
/// says what was expected and what was found ("msg.info.width: expected a whole number, got a string").
struct Refusal {
  Status status = Status::UnprocessableEntity;
  std::string sentence;
  std::size_t parts = 0;  // of a state or of markers, that it is about; 0: it is about a message
  /// The key of the setting that can prevent this refusal ("rules.map_bytes"); "": no setting can. Not owned:
  /// a literal.
  std::string_view setting = {};
  friend bool operator==(const Refusal&, const Refusal&) = default;
};

template <class T>
using Checked = std::expected<T, Refusal>;

}  // namespace adit::icd
