#pragma once

#include <optional>
#include <string>

#include "dispatch/report.hpp"
#include "dispatch/run.hpp"

namespace adit::dispatch {

/// The body of Adit's 201 for a report whose answer was lost and whose record the run's status shows: the
/// fields of ICD 5.2, null if uncertain, and `adit` with the figures.
std::string reconciled_answer(const Report& report, const Run& run, std::optional<std::int64_t> points,
                              const std::string& figures);

}  // namespace adit::dispatch
