#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "access/sessions.hpp"
#include "icd/bearer_token.hpp"
#include "icd/status.hpp"

namespace adit::access {

inline constexpr std::string_view kCookie = "adit", kDeviceCookie = "adit-device", kCsrfHeader = "Adit-CSRF";

/// True if a Host header names this box as an IP literal, "localhost" or a name in .local, with any port. A
/// foreign page cannot use these names for DNS rebinding: .local, also rooted ("adit.local."), is resolved on
/// the box's own network only (RFC 6762 3).
bool names_this_box(std::string_view host);

/// True if an Origin header (RFC 6454 7) names the requested host. `is_secure`: the request came by TLS. Then
/// a page that came without it is another origin. Otherwise a proxy may speak TLS for the box.
bool is_same_origin(std::string_view origin, std::string_view host, bool is_secure);

/// The name of this box's cookie: `name`, with the port that the Host header names ("adit-8000"). A browser
/// sends the cookies of a host to each of its ports, where other boxes may be. `is_secure`: with the prefix
/// "__Host-". A browser accepts such a cookie only from HTTPS, so no answer without TLS can replace it.
std::string cookie_name(std::string_view name, std::string_view host, bool is_secure);

/// The value of a cookie in a Cookie header (RFC 6265 4.2.1), or "".
std::string_view cookie_in(std::string_view cookies, std::string_view name);
/// The values of the cookies that may be this box's: first the one of cookie_name(), then those of other
/// ports, because the box may have moved to another port since.
std::vector<std::string_view> cookies_in(std::string_view cookies, std::string_view name,
                                         std::string_view host, bool is_secure);

/// The headers of a request that show where it comes from. An absent header is "".
struct Request {
  std::string_view method, host, origin, cookie, authorization, csrf;
  bool is_secure = false;  // it came by TLS
};

/// A client that is logged in or has shown a token.
struct Visitor {
  Role role = Role::Viewer;
  const Session* session = nullptr;  // null: a script with a token
};

/// An error (403) if the Host header does not name this box, or if the Origin header names another host.
/// Applies to all requests, even if they need no role.
icd::Checked<void> check_host_and_origin(const Request& request);

/// With an Authorization header: an operator if it contains one of `tokens`, else nullopt. Without one: the
/// owner of the session whose cookie the request shows, or nullopt.
std::optional<Visitor> find_visitor(const Request& request, std::span<const icd::BearerToken> tokens,
                                    Sessions& sessions, Instant now);

/// Checks that the request may do an action that needs `role`. 401 without a valid token or session. 403 if
/// it comes from another page, has a lower role, or is not GET or HEAD and lacks its session's CSRF token.
icd::Checked<Visitor> admit(const Request& request, Role role, std::span<const icd::BearerToken> tokens,
                            Sessions& sessions, Instant now);

}  // namespace adit::access
