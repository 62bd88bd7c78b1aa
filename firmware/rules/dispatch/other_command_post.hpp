#pragma once

#include <string>

#include "dispatch/reports.hpp"

namespace adit::dispatch {

/// A sentence about the unfinished reports, with their counts, for the case that the settings name the
/// Command Post at `post`.
std::string meaning_of_other_command_post(const Reports& reports, const std::string& post);

}  // namespace adit::dispatch
