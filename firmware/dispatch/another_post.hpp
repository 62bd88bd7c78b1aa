#pragma once

#include <string>

#include "dispatch/reports.hpp"

namespace adit::dispatch {

/// What it means for the reports that are not done, where the settings name the Command Post at `post` from
/// then on: a sentence with their counts.
std::string meaning_of_another_post(const Reports& reports, const std::string& post);

}  // namespace adit::dispatch
