#include "access/admission.hpp"

#include "access/whence.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::access {
namespace {

using icd::refuse;

bool only_reads(std::string_view method) {
  return method == "GET" || method == "HEAD";
}

}  // namespace

icd::Checked<void> check_whence(const Request& request) {
  if (!names_this_box(request.host)) {
    return refuse(icd::Status::Forbidden,
                  "Host: expected the box's address, localhost or the box's name in .local");
  }
  if (!request.origin.empty() && !is_same_origin(request.origin, request.host)) {
    return refuse(icd::Status::Forbidden, "Origin: expected a page of this box");
  }
  return {};
}

std::optional<Visitor> who(const Request& request, std::span<const icd::BearerToken> tokens,
                           Sessions& sessions, Instant now) {
  if (!request.authorization.empty()) {
    if (!icd::is_one_of(tokens, icd::token_in(request.authorization))) return std::nullopt;
    return Visitor{Role::Operator, nullptr};
  }
  const Session* const session = sessions.find(cookie_in(request.cookie, kCookie), now);
  return session == nullptr ? std::nullopt : std::optional(Visitor{session->role, session});
}

icd::Checked<Visitor> admit(const Request& request, Role role, std::span<const icd::BearerToken> tokens,
                            Sessions& sessions, Instant now) {
  ADIT_TRY(check_whence(request));
  const auto visitor = who(request, tokens, sessions, now);
  if (!visitor) {
    return refuse(icd::Status::Unauthorized, "log in, or send the team's token as Authorization: Bearer");
  }
  if (visitor->session != nullptr && !only_reads(request.method) &&
      !visitor->session->csrf.matches(request.csrf)) {
    return refuse(icd::Status::Forbidden, kCsrfHeader, ": expected the session's CSRF token");
  }
  if (visitor->role < role) {
    return refuse(icd::Status::Forbidden, "this needs the operator's role, but you are logged in as viewer");
  }
  return *visitor;
}

}  // namespace adit::access
