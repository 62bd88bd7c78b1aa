#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "api/run_view.hpp"

namespace adit::cli {

/// What api::write_run_view wrote, or why it is none. The lights, which no command
/// shows, and members that this adit does not know are left out.
std::expected<api::RunView, std::string> read_run_view(std::string_view json);

}  // namespace adit::cli
