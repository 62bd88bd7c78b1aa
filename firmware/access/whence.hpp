#pragma once

#include <string_view>

namespace adit::access {

/// Whether a Host header's value names this box in a way that no page from elsewhere can: as an IP literal,
/// "localhost" or a name in .local, with any port. A name that somebody else's DNS resolves to the box's
/// address (DNS rebinding) is none of these: .local is told on the box's own network alone (RFC 6762 3),
/// where a PC has the name that its owner gave it, and one of two boxes another than adit.local.
bool names_this_box(std::string_view host);

/// Whether an Origin header's value (RFC 6454 7) is a page of the very host that is asked.
bool is_same_origin(std::string_view origin, std::string_view host);

/// The value of a cookie in a Cookie header (RFC 6265 4.2.1); "" where there is none.
std::string_view cookie_in(std::string_view cookies, std::string_view name);

}  // namespace adit::access
