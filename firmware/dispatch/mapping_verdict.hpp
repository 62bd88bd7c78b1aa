#pragma once

#include <cstdint>
#include <string_view>

namespace adit::dispatch {

/// What an answer's body is, whatever its Content-Type says.
enum class Body : std::uint8_t { Empty, Json, Other };
Body body_of(std::string_view body);

/// Whether a Command Post may have answered this. It answers with JSON or an empty body; 404 and 5xx may be
/// pages of its server, 429 a page of something before it. A redirect, or any other status with a page, comes
/// from somebody else: a captive portal, a proxy, a wrong address.
bool may_be_the_command_post(int status, Body body);
/// Whether it did for certain, as far as an answer can tell: whatever is in between refuses and fails with
/// JSON, too.
bool is_the_command_post(int status, Body body);

/// What became of a message to the mapping endpoint.
enum class MappingVerdict : std::uint8_t {
  Taken,      // 2xx with JSON or nothing
  Throttled,  // 429: slow down and send it again
  Refused,    // 400, 413, 422 with JSON or nothing: it will never be taken
  Suspect,    // 500, or 400, 413, 422 with a page: this message's fault, if others pass (lanes::Blame)
  Failing,    // anything else (also 401 and 404: somebody may mend the settings or the Command Post): send it
              // again later
};
MappingVerdict mapping_verdict(int status, Body body);

}  // namespace adit::dispatch
