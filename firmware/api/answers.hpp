#pragma once

#include <string>
#include <string_view>

#include "codec/value.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// With the headers that keep a browser from loading, framing or guessing anything.
intake::Answer guarded(intake::Answer answer);

/// 200, for nobody to keep.
intake::Answer fresh(std::string content_type, std::string body);

/// The same, of a JSON object.
intake::Answer object(codec::Value::Object members);

intake::Answer refusal(icd::Status status, std::string_view sentence);
intake::Answer refused(const icd::Refusal& why);
/// Of a change of the set-up, which is refused with 409 only while another is being applied (api::Setup):
/// that takes a second, and Retry-After says so.
intake::Answer refused_change(const icd::Refusal& why);
intake::Answer nothing_here();
/// 405; `allowed` as in RFC 9110 10.2.1: "GET, HEAD".
intake::Answer wrong_method(std::string_view allowed);

inline constexpr auto kNotModified = static_cast<icd::Status>(304);  // RFC 9110 15.4.5; no ICD answer has it

inline constexpr std::string_view kReading = "GET, HEAD";
inline bool only_reads(const intake::RequestHead& head) {
  return head.method() == "GET" || head.method() == "HEAD";
}

}  // namespace adit::api
