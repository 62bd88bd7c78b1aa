#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "codec/row.hpp"
#include "codec/value.hpp"
#include "icd/bearer_token.hpp"
#include "intake/listen_socket.hpp"
#include "intake/server.hpp"
#include "settings/settings.hpp"

namespace adit::api {

/// Whether a client accepts gzip (RFC 9110 12.5.3). No header means no, because scripts expect plain text.
bool accepts_gzip(std::string_view accept_encoding);

/// Whether an answer's body is compressed by gzip.
bool is_packed(const intake::Answer& answer);

/// Compresses a body with gzip if that pays: text and JSON of some kB up to 1 MiB, because the loop does it
/// (2 ms for each 256 KiB on a desk machine). An ETag names its body's bytes, so such a body stays unchanged.
void pack_if_worthwhile(intake::Answer& answer);

/// Adds headers against loading, framing and content sniffing.
intake::Answer add_headers(intake::Answer answer);

/// 200, not cached.
intake::Answer uncached_answer(std::string content_type, std::string body);

/// The same for a row or rows, as JSON.
template <class Rows>
intake::Answer uncached_answer(const Rows& rows) {
  return uncached_answer("application/json", codec::to_json(rows));
}

/// The same for a JSON object.
intake::Answer object(codec::Value::Object members);

/// The answer as a file that a browser saves under this name.
intake::Answer download(intake::Answer answer, const std::string& name);

intake::Answer refusal(icd::Status status, std::string_view sentence);
intake::Answer refusal_answer(const icd::Refusal& why);
/// 422 for numbers or settings that have these errors.
intake::Answer refusal_answer(const std::vector<settings::Error>& errors);
/// The answer to an action of an interface such as Clock: its state(), or the refusal.
template <class Part>
intake::Answer answer_after(const Part& part, const icd::Checked<void>& done) {
  return done ? uncached_answer(part.state()) : refusal_answer(done.error());
}
/// Refusal of a change. 409 (api::Setup applies another one) has Retry-After, because that takes a second.
intake::Answer refused_change(const icd::Refusal& why);
icd::Refusal nothing_at(std::string_view path);
/// 405; `allowed` as in RFC 9110 10.2.1: "GET, HEAD".
intake::Answer wrong_method(std::string_view allowed);

inline constexpr auto kNotModified = static_cast<icd::Status>(304);  // RFC 9110 15.4.5; not in the ICD

inline constexpr auto kPermanentRedirect = static_cast<icd::Status>(308);  // 15.4.9; not in the ICD

/// True if a program of this machine sent it, so that nobody on a network can read it.
inline bool is_from_this_machine(const intake::RequestHead& head) {
  return head.peer() == head.local() || intake::is_loopback(head.local());
}

inline constexpr std::string_view kReading = "GET, HEAD";
inline bool is_read_only(const intake::RequestHead& head) {
  return head.method() == "GET" || head.method() == "HEAD";
}

using SharedRedaction = std::shared_ptr<const icd::Redaction>;
/// The present redaction, for use on the loop alone, because tokens change while a page is open.
using PresentRedaction = std::shared_ptr<const SharedRedaction>;

/// Redacts a body of this Content-Type. Images, archives and the page's files stay unchanged.
void redact(const icd::Redaction& redaction, std::string_view content_type, std::string& body);

/// Forwards answers and streams after redaction. Compresses answers if `head` accepts gzip and it pays.
std::shared_ptr<intake::Responder> redact_answers(std::shared_ptr<intake::Responder> responder,
                                                  PresentRedaction redaction,
                                                  const intake::RequestHead& head);

}  // namespace adit::api
