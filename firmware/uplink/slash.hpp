#pragma once

#include <string_view>

namespace adit::uplink {

/// True if an answer redirects a request to the same path with a slash at its end on the same server (RFC
/// 9110 15.4): the target "/map/update" to the location "/map/update/" or
/// "http://10.100.1.201:8000/map/update/". `authority`: host and port of the request.
bool redirects_to_slash(int status, std::string_view location, std::string_view authority,
                        std::string_view target);

}  // namespace adit::uplink
