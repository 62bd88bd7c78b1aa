#pragma once

#include <string>
#include <string_view>

#include "codec/value.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// With the headers that keep a browser from loading, framing or guessing anything.
intake::Answer guarded(intake::Answer answer);

/// 200, not to be cached.
intake::Answer fresh(std::string content_type, std::string body);

/// The same, of a JSON object.
intake::Answer object(codec::Value::Object members);

intake::Answer refusal(icd::Status status, std::string_view sentence);
intake::Answer refused(const icd::Refusal& why);
/// The refusal of a change of the set-up. 409 means that another is being applied (api::Setup), which takes a
/// second: Retry-After says so.
intake::Answer refused_change(const icd::Refusal& why);
intake::Answer nothing_at(std::string_view path);
/// 405; `allowed` as in RFC 9110 10.2.1: "GET, HEAD".
intake::Answer wrong_method(std::string_view allowed);

inline constexpr auto kNotModified = static_cast<icd::Status>(304);  // RFC 9110 15.4.5; no ICD answer has it

inline constexpr std::string_view kReading = "GET, HEAD";
inline bool only_reads(const intake::RequestHead& head) {
  return head.method() == "GET" || head.method() == "HEAD";
}

}  // namespace adit::api
