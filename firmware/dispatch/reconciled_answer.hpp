#pragma once

#include <optional>
#include <string>

#include "dispatch/report.hpp"
#include "dispatch/run.hpp"

namespace adit::dispatch {

/// The body of the 201 that Adit gives for a report whose own answer was lost and whose record was found in
/// the run's status: ICD 5.2's fields as far as they are known to be true, null for the rest (url, id, and
/// what is not certain), and `adit`, which says so and gives the figures.
std::string reconciled_answer(const Report& report, const Run& run, std::optional<std::int64_t> points,
                              const std::string& figures);

}  // namespace adit::dispatch
