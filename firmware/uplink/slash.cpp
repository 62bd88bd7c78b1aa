#include "uplink/slash.hpp"

#include <algorithm>
#include <string>

namespace adit::uplink {
namespace {

bool same_in_any_case(std::string_view one, std::string_view other) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::ranges::equal(one, other, {}, lower, lower);
}

}  // namespace

bool redirects_to_slash(int status, std::string_view location, std::string_view authority,
                        std::string_view target) {
  constexpr std::string_view kScheme = "http://";
  const bool redirects = status == 301 || status == 302 || status == 307 || status == 308;
  if (!redirects || target.ends_with('/')) return false;
  if (same_in_any_case(location.substr(0, kScheme.size()), kScheme)) {
    location.remove_prefix(kScheme.size());
    std::string there(location.substr(0, location.find('/')));
    location.remove_prefix(there.size());
    const bool has_port = there.find(':', there.rfind(']') + 1) != std::string::npos;
    if (!has_port) there += ":80";
    if (!same_in_any_case(there, authority)) return false;
  }
  return location.size() == target.size() + 1 && location.starts_with(target) && location.ends_with('/');
}

}  // namespace adit::uplink
