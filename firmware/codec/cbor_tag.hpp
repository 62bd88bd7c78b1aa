#pragma once

#include <cstdint>
#include <string>

namespace adit::codec {

/// Whether a registered tag only annotates its content, so that a text, number, byte string, array or map
/// keeps its meaning.
bool is_remark(std::uint64_t tag);

/// Describes another tag for a sentence.
std::string tag_that_changes(std::uint64_t tag);

}  // namespace adit::codec
