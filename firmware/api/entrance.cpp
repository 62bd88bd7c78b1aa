#include "api/entrance.hpp"

#include "api/answers.hpp"

namespace adit::api {

access::Request request_of(const intake::RequestHead& head) {
  return {.method = head.method(),
          .host = head.header("Host"),
          .origin = head.header("Origin"),
          .cookie = head.header("Cookie"),
          .authorization = head.header("Authorization"),
          .csrf = head.header(access::kCsrfHeader)};
}

icd::Checked<access::Visitor> Entrance::admit(const intake::RequestHead& head, access::Role role) {
  return access::admit(request_of(head), role, tokens_, sessions_, loop_.now());
}

std::optional<access::Visitor> Entrance::who(const intake::RequestHead& head) {
  return access::who(request_of(head), tokens_, sessions_, loop_.now());
}

std::function<bool()> Entrance::may_stay(const access::Visitor& visitor) {
  if (visitor.session == nullptr) return [] { return true; };
  return [this, number = visitor.session->number] { return sessions_.still(number, loop_.now()); };
}

intake::Answer turned_away(const icd::Refusal& why) {
  auto answer = refusal(why.status, why.sentence);
  if (why.status == icd::Status::Unauthorized) answer.headers.push_back({"WWW-Authenticate", "Bearer"});
  return answer;
}

}  // namespace adit::api
