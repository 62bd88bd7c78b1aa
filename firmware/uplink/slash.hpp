#pragma once

#include <string_view>

namespace adit::uplink {

/// Whether an answer redirects a request to the same path with a slash at its end, at the same place (RFC
/// 9110 15.4): for the target "/map/update" by the location "/map/update/", or
/// "http://10.100.1.201:8000/map/update/". `authority`: host and port that the request was sent to.
bool redirects_to_slash(int status, std::string_view location, std::string_view authority,
                        std::string_view target);

}  // namespace adit::uplink
