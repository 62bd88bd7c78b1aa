#pragma once

#include <cstdint>
#include <string>

namespace adit::codec {

/// Of the tags that IANA has registered, one that leaves its content what it is: a text, a number, bytes, an
/// array or a map.
bool is_remark(std::uint64_t tag);

/// Another tag, for a sentence.
std::string tag_that_changes(std::uint64_t tag);

}  // namespace adit::codec
