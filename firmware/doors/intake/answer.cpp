#include "intake/answer.hpp"

#include <microhttpd.h>

#include <memory>
#include <utility>

#include "codec/write.hpp"
#include "intake/head.hpp"

namespace adit::intake {
namespace {

void add_header(MHD_Response* response, const char* name, const std::string& value) {
  if (is_field_value(value)) MHD_add_response_header(response, name, value.c_str());
}

void append_field(std::string& text, std::string_view name, std::string_view value) {
  if (!is_field_value(value)) return;
  text.append(name).append(": ").append(value).append("\r\n");
}

bool may_have_body(const Answer& answer) {
  return answer.status != icd::Status::NoContent;
}

}  // namespace

Answer error_answer(icd::Status status, std::string_view sentence) {
  return {.status = status, .body = codec::json_string(sentence), .headers = {}};
}

Answer retry_answer(icd::Status status, std::string_view sentence) {
  Answer answer = error_answer(status, sentence);
  answer.headers.push_back({"Retry-After", "1"});
  return answer;
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
  if (may_have_body(answer)) add_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, answer.content_type);
  for (const Header& header : answer.headers) add_header(response, header.name.c_str(), header.value);
  return response;
}

std::string last_answer_text(const Answer& answer, bool with_body) {
  const auto code = static_cast<unsigned>(answer.status);
  std::string text = "HTTP/1.1 " + std::to_string(code) + " " + MHD_get_reason_phrase_for(code) + "\r\n";
  append_field(text, MHD_HTTP_HEADER_CONNECTION, "close");
  if (may_have_body(answer)) {
    append_field(text, MHD_HTTP_HEADER_CONTENT_TYPE, answer.content_type);
    append_field(text, MHD_HTTP_HEADER_CONTENT_LENGTH, std::to_string(answer.body.size()));
  }
  for (const Header& header : answer.headers) append_field(text, header.name, header.value);
  text += "\r\n";
  if (with_body && may_have_body(answer)) text += answer.body;
  return text;
}

}  // namespace adit::intake
