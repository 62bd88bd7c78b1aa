#include "intake/answer.hpp"

#include <microhttpd.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "codec/write.hpp"
#include "intake/head.hpp"

namespace adit::intake {
namespace {

void append_field(std::string& text, std::string_view name, std::string_view value) {
  text.append(name).append(": ").append(value).append("\r\n");
}

bool can_have_body(const Answer& answer) {
  return answer.status != icd::Status::NoContent;
}

bool lacks_retry_after(const Answer& answer) {
  return (answer.status == icd::Status::TooManyRequests ||
          answer.status == icd::Status::ServiceUnavailable) &&
         std::ranges::count(answer.headers, MHD_HTTP_HEADER_RETRY_AFTER, &Header::name) == 0;
}

/// Calls `add(name, value)` for each valid field of `answer`.
template <class Add>
void add_fields(const Answer& answer, const Add& add) {
  const auto add_valid = [&add](const std::string& name, const std::string& value) {
    if (is_field_value(value)) add(name.c_str(), value.c_str());
  };
  if (can_have_body(answer)) add_valid(MHD_HTTP_HEADER_CONTENT_TYPE, answer.content_type);
  for (const Header& header : answer.headers) add_valid(header.name, header.value);
  if (lacks_retry_after(answer)) add_valid(MHD_HTTP_HEADER_RETRY_AFTER, "1");
}

}  // namespace

Answer error_answer(icd::Status status, std::string_view sentence) {
  return {.status = status, .body = codec::json_string(sentence), .headers = {}};
}

void allow_any_origin(Answer& answer) {
  answer.headers.push_back({"Access-Control-Allow-Origin", "*"});
  answer.headers.push_back(
      {"Access-Control-Expose-Headers", "Age, Retry-After, Adit-Report, Adit-Reconciled"});
}

bool is_field_value(std::string_view text) {
  return !text.empty() && has_no_controls(text);
}

MHD_Response* make_response(Answer& answer) {
  auto body = std::make_unique<std::string>(std::move(answer.body));
  MHD_Response* response = MHD_create_response_from_buffer_with_free_callback_cls(
      body->size(), body->data(),
      [](void* cls) { const std::unique_ptr<std::string> freed(static_cast<std::string*>(cls)); },
      body.get());
  if (response == nullptr) return nullptr;
  body.release();  // NOLINT(bugprone-unused-return-value): the response owns it now
  add_fields(answer, [response](const char* name, const char* value) {
    MHD_add_response_header(response, name, value);
  });
  return response;
}

std::string last_answer_text(const Answer& answer, bool with_body) {
  const auto code = static_cast<unsigned>(answer.status);
  std::string text = "HTTP/1.1 " + std::to_string(code) + " " + MHD_get_reason_phrase_for(code) + "\r\n";
  append_field(text, MHD_HTTP_HEADER_CONNECTION, "close");
  if (can_have_body(answer)) {
    append_field(text, MHD_HTTP_HEADER_CONTENT_LENGTH, std::to_string(answer.body.size()));
  }
  add_fields(answer, [&text](const char* name, const char* value) { append_field(text, name, value); });
  text += "\r\n";
  if (with_body && can_have_body(answer)) text += answer.body;
  return text;
}

}  // namespace adit::intake
