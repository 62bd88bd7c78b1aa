#include "api/answers.hpp"

#include <utility>

#include "codec/json.hpp"
#include "icd/sentence.hpp"
#include "intake/icd_routes.hpp"

namespace adit::api {
namespace {

/// The page may load and call only its own files, and no page may frame it.
constexpr const char* kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
    "worker-src 'self'; base-uri 'none'; frame-ancestors 'none'; form-action 'none'";

}  // namespace

intake::Answer guarded(intake::Answer answer) {
  answer.headers.push_back({"Content-Security-Policy", kContentSecurityPolicy});
  answer.headers.push_back({"X-Content-Type-Options", "nosniff"});
  answer.headers.push_back({"Referrer-Policy", "no-referrer"});
  return answer;
}

intake::Answer fresh(std::string content_type, std::string body) {
  return guarded({.content_type = std::move(content_type),
                  .body = std::move(body),
                  .headers = {{"Cache-Control", "no-store"}}});
}

intake::Answer object(codec::Value::Object members) {
  return fresh("application/json", codec::write_json({std::move(members)}));
}

intake::Answer refused(const icd::Refusal& why) {
  return refusal(why.status, why.sentence);
}

intake::Answer refused_change(const icd::Refusal& why) {
  auto answer = refused(why);
  if (why.status == icd::Status::Conflict) answer.headers.push_back({"Retry-After", "1"});
  return answer;
}

intake::Answer refusal(icd::Status status, std::string_view sentence) {
  return guarded(intake::error_answer(status, sentence));
}

intake::Answer nothing_at(std::string_view path) {
  return refusal(icd::Status::NotFound, icd::sentence("there is no resource at ", icd::in_quotes(path)));
}

intake::Answer wrong_method(std::string_view allowed) {
  const auto first = allowed.substr(0, allowed.find(','));
  auto answer = refusal(icd::Status::MethodNotAllowed, icd::sentence("expected ", first));
  answer.headers.push_back({"Allow", std::string(allowed)});
  return answer;
}

}  // namespace adit::api
