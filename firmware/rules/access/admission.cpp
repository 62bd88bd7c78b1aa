#include "access/admission.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <string>

#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::access {
namespace {

using icd::equals_ignoring_case;
using icd::refuse;

bool is_address(int family, std::string_view text) {
  unsigned char bytes[sizeof(in6_addr)];
  return !text.contains('\0') && inet_pton(family, std::string(text).c_str(), bytes) == 1;
}

/// "adit.local" or "adit.local.": one label, of letters, digits and hyphens (RFC 6762 3).
bool is_multicast_name(std::string_view name) {
  if (name.ends_with('.')) name.remove_suffix(1);
  constexpr std::string_view kEnd = ".local";
  if (name.size() <= kEnd.size() || !equals_ignoring_case(name.substr(name.size() - kEnd.size()), kEnd))
    return false;
  return std::ranges::all_of(name.substr(0, name.size() - kEnd.size()),
                             [](char letter) { return icd::is_letter_or_digit(letter) || letter == '-'; });
}

bool is_port(std::string_view text) {
  return text.empty() ||
         (text.front() == ':' && text.size() <= 6 && std::ranges::all_of(text.substr(1), icd::is_digit));
}

constexpr std::string_view kProxyHint =
    "; a proxy must pass Host on (nginx: proxy_set_header Host $http_host; haproxy: no set-header Host)";

constexpr std::string_view kSecurePrefix = "__Host-";  // RFC 6265bis 4.1.3.2

bool is_read_only(std::string_view method) {
  return method == "GET" || method == "HEAD";
}

}  // namespace

bool names_this_box(std::string_view host) {
  if (host.starts_with('[')) {
    const auto end = host.find(']');
    return end != std::string_view::npos && is_address(AF_INET6, host.substr(1, end - 1)) &&
           is_port(host.substr(end + 1));
  }
  const std::string_view name = host.substr(0, host.find(':'));
  if (!is_port(host.substr(name.size()))) return false;
  return equals_ignoring_case(name, "localhost") || is_multicast_name(name) || is_address(AF_INET, name);
}

bool is_same_origin(std::string_view origin, std::string_view host, bool is_secure) {
  for (const std::string_view scheme : {"https://", "http://"}) {
    if (is_secure && scheme != "https://") break;
    if (equals_ignoring_case(origin.substr(0, scheme.size()), scheme))
      return equals_ignoring_case(origin.substr(scheme.size()), host);
  }
  return false;
}

std::string cookie_name(std::string_view name, std::string_view host, bool is_secure) {
  const std::size_t colon = host.rfind(':');
  const std::string_view port = colon == std::string_view::npos ? "" : host.substr(colon + 1);
  const bool is_given = !port.empty() && std::ranges::all_of(port, icd::is_digit);  // else of "[fd00::1]"
  return icd::sentence(is_secure ? kSecurePrefix : "", name, is_given ? "-" : "", is_given ? port : "");
}

std::string_view cookie_in(std::string_view cookies, std::string_view name) {
  while (!cookies.empty()) {
    const std::string_view pair = icd::trim(icd::cut(cookies, ';'), " \t");
    if (pair.starts_with(name) && pair.substr(name.size()).starts_with('='))
      return pair.substr(name.size() + 1);
  }
  return {};
}

std::vector<std::string_view> cookies_in(std::string_view cookies, std::string_view name,
                                         std::string_view host, bool is_secure) {
  std::vector<std::string_view> values{cookie_in(cookies, cookie_name(name, host, is_secure))};
  while (!cookies.empty()) {
    std::string_view value = icd::trim(icd::cut(cookies, ';'), " \t");
    std::string_view each = icd::cut(value, '=');
    if (each.starts_with(kSecurePrefix) != is_secure) continue;
    if (is_secure) each.remove_prefix(kSecurePrefix.size());
    if (!each.starts_with(name)) continue;
    const std::string_view port = each.substr(name.size());
    const bool is_ours =
        port.empty() || (port.starts_with('-') && std::ranges::all_of(port.substr(1), icd::is_digit));
    if (is_ours && value != values.front()) values.push_back(value);
  }
  return values;
}

icd::Checked<void> check_host_and_origin(const Request& request) {
  if (!names_this_box(request.host)) {
    return refuse(icd::Status::Forbidden,
                  "Host: expected the box's address, localhost or the box's name in .local, got ",
                  icd::quote_text(request.host), kProxyHint);
  }
  if (!request.origin.empty() && !is_same_origin(request.origin, request.host, request.is_secure)) {
    return refuse(icd::Status::Forbidden, "Origin: expected a page of this box, got ",
                  icd::quote_text(request.origin), " with Host ", icd::quote_text(request.host), kProxyHint);
  }
  return {};
}

std::optional<Visitor> find_visitor(const Request& request, std::span<const icd::BearerToken> tokens,
                                    Sessions& sessions, Instant now) {
  if (!request.authorization.empty()) {
    if (!icd::is_one_of(tokens, icd::token_in(request.authorization))) return std::nullopt;
    return Visitor{Role::Operator, nullptr};
  }
  for (const std::string_view id : cookies_in(request.cookie, kCookie, request.host, request.is_secure)) {
    if (const Session* const session = sessions.find(id, now)) return Visitor{session->role, session};
  }
  return std::nullopt;
}

icd::Checked<Visitor> admit(const Request& request, Role role, std::span<const icd::BearerToken> tokens,
                            Sessions& sessions, Instant now) {
  ADIT_TRY(check_host_and_origin(request));
  const auto visitor = find_visitor(request, tokens, sessions, now);
  if (!visitor) {
    return refuse(icd::Status::Unauthorized, "log in, or send the team's token as Authorization: Bearer");
  }
  if (visitor->session != nullptr && !is_read_only(request.method) &&
      !visitor->session->csrf.matches(request.csrf)) {
    return refuse(icd::Status::Forbidden, kCsrfHeader, ": expected the session's CSRF token");
  }
  if (visitor->role < role) {
    return refuse(icd::Status::Forbidden, "this needs the operator's role, but you are logged in as viewer");
  }
  return *visitor;
}

}  // namespace adit::access
