#include "api/authenticator.hpp"

#include "access/admission.hpp"
#include "api/answers.hpp"
#include "icd/try.hpp"

namespace adit::api {
namespace {

access::Request request_of(const intake::RequestHead& head) {
  return {.method = head.method(),
          .host = head.header("Host"),
          .origin = head.header("Origin"),
          .cookie = head.header("Cookie"),
          .authorization = head.header("Authorization"),
          .csrf = head.header(access::kCsrfHeader),
          .is_secure = head.is_secure()};
}

std::uint64_t session_of(const access::Visitor& visitor) {
  return visitor.session == nullptr ? 0 : visitor.session->number;
}

}  // namespace

icd::Checked<Asker> Authenticator::admit(const intake::RequestHead& head, RouteAccess who) {
  if (who == RouteAccess::Open) return Asker{};
  const auto request = request_of(head);
  const auto role = who == RouteAccess::Viewer ? access::Role::Viewer : access::Role::Operator;
  const auto visitor = access::admit(request, role, tokens_, keys_.sessions(), loop_.now());
  if (visitor) return Asker{.admitted = true, .session = session_of(*visitor)};
  const bool for_anybody = who == RouteAccess::OwnPage || (who == RouteAccess::OperatorOrSetUp &&
                                                           (keys_.first_start() || keys_.set_up_open()));
  if (!for_anybody) return std::unexpected(visitor.error());
  ADIT_TRY(access::check_host_and_origin(request));
  const auto known = this->find_visitor(head);
  return Asker{.admitted = false, .session = known ? session_of(*known) : 0};
}

std::optional<access::Visitor> Authenticator::find_visitor(const intake::RequestHead& head) {
  return access::find_visitor(request_of(head), tokens_, keys_.sessions(), loop_.now());
}

intake::Credentials Authenticator::read_credentials(const intake::RequestHead& head) {
  const auto visitor = find_visitor(head);
  if (!head.header("Authorization").empty())
    return visitor ? intake::Credentials::Token : intake::Credentials::WrongToken;
  if (visitor) return intake::Credentials::Enough;
  // A known device has room for a login, however many clients guess passwords.
  return device(head) == nullptr ? intake::Credentials::Nothing : intake::Credentials::Enough;
}

const access::Device* Authenticator::device(const intake::RequestHead& head) {
  const auto ids =
      access::cookies_in(head.header("Cookie"), access::kDeviceCookie, head.header("Host"), head.is_secure());
  for (const std::string_view id : ids) {
    if (const access::Device* const known = keys_.devices().find(id)) return known;
  }
  return nullptr;
}

std::function<bool()> Authenticator::access_check(const Asker& asker) {
  if (asker.session == 0) return [] { return true; };
  return [this, number = asker.session] { return keys_.sessions().touch(number, loop_.now()); };
}

intake::Answer rejection_answer(const icd::Refusal& why) {
  auto answer = refusal_answer(why);
  if (why.status == icd::Status::Unauthorized) answer.headers.push_back({"WWW-Authenticate", "Bearer"});
  return answer;
}

}  // namespace adit::api
