#pragma once

#include <string>
#include <string_view>

#include "codec/row.hpp"
#include "codec/value.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// Adds headers against loading, framing and content sniffing.
intake::Answer guarded(intake::Answer answer);

/// 200, not cached.
intake::Answer fresh(std::string content_type, std::string body);

/// The same for a row or rows, as JSON.
template <class Rows>
intake::Answer fresh(const Rows& rows) {
  return fresh("application/json", codec::to_json(rows));
}

/// The same for a JSON object.
intake::Answer object(codec::Value::Object members);

intake::Answer refusal(icd::Status status, std::string_view sentence);
intake::Answer refused(const icd::Refusal& why);
/// Refusal of a change of the settings. 409 while another change is being applied (api::Setup) has
/// Retry-After, because that takes a second.
intake::Answer refused_change(const icd::Refusal& why);
intake::Answer nothing_at(std::string_view path);
/// 405; `allowed` as in RFC 9110 10.2.1: "GET, HEAD".
intake::Answer wrong_method(std::string_view allowed);

inline constexpr auto kNotModified = static_cast<icd::Status>(304);  // RFC 9110 15.4.5; not in the ICD

inline constexpr std::string_view kReading = "GET, HEAD";
inline bool only_reads(const intake::RequestHead& head) {
  return head.method() == "GET" || head.method() == "HEAD";
}

}  // namespace adit::api
