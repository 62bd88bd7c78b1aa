#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace adit::rehearsal {

/// RFC 4648 4: the standard alphabet, padded, with no other character in it. Nothing where it is not that.
std::optional<std::string> base64_decoded(std::string_view text);

}  // namespace adit::rehearsal
