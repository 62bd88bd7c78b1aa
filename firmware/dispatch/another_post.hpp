#pragma once

#include <string>

#include "dispatch/reports.hpp"

namespace adit::dispatch {

/// What it would mean for the unfinished reports if the settings named the Command Post at `post`: a sentence
/// with their counts.
std::string meaning_of_another_post(const Reports& reports, const std::string& post);

}  // namespace adit::dispatch
