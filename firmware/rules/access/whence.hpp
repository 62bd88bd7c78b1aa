#pragma once

#include <string_view>

namespace adit::access {

/// True if a Host header names this box as an IP literal, "localhost" or a name in .local, with any port. A
/// foreign page cannot use these names for DNS rebinding: .local is resolved on the box's own network only
/// (RFC 6762 3).
bool names_this_box(std::string_view host);

/// True if an Origin header (RFC 6454 7) names the requested host.
bool is_same_origin(std::string_view origin, std::string_view host);

/// The value of a cookie in a Cookie header (RFC 6265 4.2.1), or "".
std::string_view cookie_in(std::string_view cookies, std::string_view name);

}  // namespace adit::access
