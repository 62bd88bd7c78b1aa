#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace adit::host {

/// Bytes of the file system that a folder is on, free for this user; nothing: it cannot be asked.
std::optional<std::uint64_t> free_bytes(const std::string& folder);

}  // namespace adit::host
