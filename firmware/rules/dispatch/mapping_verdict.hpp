#pragma once

#include <cstdint>
#include <string_view>

#include "icd/status.hpp"

namespace adit::dispatch {

/// The kind of a body by its bytes. Content-Type is ignored.
enum class Body : std::uint8_t { Empty, Json, Other };
Body body_of(std::string_view body);

/// Whether a Command Post may have sent this answer: JSON, an empty body, or a page with 404, 429 or 5xx.
/// Redirects and other pages come from other machines, such as a captive portal.
bool may_be_the_command_post(int status, Body body);
/// 2xx with JSON. An error does not identify the Command Post, because proxies send JSON errors.
bool is_the_command_post(int status, Body body);

/// 413 to a map, a state or markers.
inline constexpr int kTooLarge = static_cast<int>(icd::Status::ContentTooLarge);

enum class MappingVerdict : std::uint8_t {
  Taken,      // 2xx with JSON or an empty body
  Throttled,  // 429: retry more slowly
  Refused,    // 400, 422 with JSON or an empty body: do not retry
  TooLarge,   // 413 with any body: send less; the Command Post or a proxy before it has a limit
  Suspect,    // 409, 415, 500, or 400, 422 with a page: at fault if others pass (queues::Blame)
  Failing,    // all others: retry
};
MappingVerdict mapping_verdict(int status, Body body);
/// Whether only a part of the message may have failed, such as one robot's pose: any answer but 2xx and 429.
bool may_concern_a_part(int status);

}  // namespace adit::dispatch
