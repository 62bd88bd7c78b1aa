#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "page/page.hpp"

namespace adit::cli {

/// What page::write_run_view wrote, or why it is none. The lights, which no command
/// shows, and members that this adit does not know are left out.
std::expected<page::RunView, std::string> read_run_view(std::string_view json);

}  // namespace adit::cli
