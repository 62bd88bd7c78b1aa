#pragma once

#include <string>

#include "dispatch/report.hpp"

namespace adit::dispatch {

/// How much a run clock may seem to run backward within one run.
inline constexpr double kClockJitter = 1.0;  // seconds
/// Within a shorter silence than this no run ends and another overtakes its clock unnoticed.
inline constexpr double kShortSilence = 30.0;  // seconds

/// Why a status heard `silence` seconds after the last word of `run` is one of another run, or "": another
/// team, a clock that ran backward, or, after a long silence, one that does not fit the time that went by.
std::string another_run(const Run& run, const icd::RunStatus& status, double silence);

/// The same of an answer to a report, by its `run` and its run_clock (ICD 5.2).
std::string another_run(const Run& run, const icd::ReportReply& reply, double silence);

}  // namespace adit::dispatch
