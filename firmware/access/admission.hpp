#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "access/sessions.hpp"
#include "icd/bearer_token.hpp"
#include "icd/status.hpp"

namespace adit::access {

inline constexpr std::string_view kCookie = "adit", kDeviceCookie = "adit-device", kCsrfHeader = "Adit-CSRF";

/// What a request says of where it comes from; the headers by their names, "" where absent.
struct Request {
  std::string_view method, host, origin, cookie, authorization, csrf;
};

/// Somebody who may come in.
struct Visitor {
  Role role = Role::Viewer;
  const Session* session = nullptr;  // null: a script, by its token
};

/// Whether the request comes from a page of this box, or from no page at all (403 otherwise): asked of all,
/// even of those who need no role.
icd::Checked<void> check_whence(const Request& request);

/// Who asks: by one of the tokens, an operator; by a session's cookie, whoever logged in. Nobody (nothing)
/// where neither is good.
std::optional<Visitor> who(const Request& request, std::span<const icd::BearerToken> tokens,
                           Sessions& sessions, Instant now);

/// Whether the request may do what needs `role`: 401 nobody is logged in, 403 from another page, without the
/// session's CSRF token where it changes anything (all methods but GET and HEAD), or by a lower role.
icd::Checked<Visitor> admit(const Request& request, Role role, std::span<const icd::BearerToken> tokens,
                            Sessions& sessions, Instant now);

}  // namespace adit::access
