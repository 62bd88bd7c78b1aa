#pragma once

#include <expected>
#include <filesystem>
#include <stop_token>
#include <string>

#include "rehearsal/robots/client.hpp"

namespace adit::robots {

/// Posts one map file, again after a 429 or where no answer came, and then waits as long as a client that
/// keeps to one map a second. A sentence of what was posted; or why the file cannot be.
std::expected<std::string, std::string> replay_file(const std::filesystem::path& file, Client& client,
                                                    const std::stop_token& finish);

}  // namespace adit::robots
