#include <algorithm>

#include "icd/sentence.hpp"
#include "ledger/book.hpp"

/// The rules for missing records (README.md, "Damage").
namespace adit::ledger {
namespace {

using dispatch::Report;
using dispatch::ReportState;
using dispatch::Run;

constexpr std::int64_t kNumbersKeptFree = 1000;  // at least the most that can have been queued
constexpr const char* kDamaged = "the ledger was damaged: the Command Post's earlier counts are not certain";
constexpr const char* kHeld = "the ledger was damaged: it may have been sent since; the operator decides";

bool is_final(const Report& report) {
  using enum ReportState;
  return report.state == Answered || report.state == Settled || report.state == Withdrawn || report.is_lost();
}

/// "report 7 is", "reports 7 to 9 are"
std::string subject(std::int64_t from, std::int64_t to) {
  return from == to ? icd::sentence("report ", from, " is")
                    : icd::sentence("reports ", from, " to ", to, " are");
}

}  // namespace

std::string Book::salvage(double now, std::int64_t expected, bool end_is_lost) {
  const std::vector<Report> all = reports();
  for (Report report : all) {
    if (is_final(report)) continue;
    report.state = ReportState::InDoubt;
    report.changed = now;
    report.note = kHeld;
    report.before.reset();
    report.counted = false;
    put(report);
  }
  // Without its record, the present run is the latest report's. Any other run may be resumed.
  std::int64_t last_run = runs_.empty() ? 1 : runs_.rbegin()->first;
  for (const Report& report : all) last_run = std::max(last_run, report.run);
  if (!runs_.contains(last_run)) {
    runs_[last_run] = encoded(Run{.number = last_run, .began = now, .why = "the ledger was damaged"});
  }
  for (auto& [number, kept] : runs_) {
    Run run = *run_in(kept);
    if (run.unreliable.empty()) run.unreliable = kDamaged;
    kept = encoded(run, more_of_run(kept));
  }
  highest_ = std::max(highest_, expected);
  std::string missing;
  std::int64_t next = 1;
  const auto miss = [&](std::int64_t from, std::int64_t to) {
    const std::string lost = subject(from, to) + " lost from the ledger";
    lose(to, lost + ": it may have been sent", now);
    missing += "; " + lost;
  };
  for (const Report& report : all) {  // a report that stands for others leaves no gap before it
    if (report.number > next && !report.is_lost()) miss(next, report.number - 1);
    next = report.number + 1;
  }
  if (next <= highest_) miss(next, highest_);
  if (end_is_lost) {
    next = highest_ + 1;
    const std::string lost = icd::sentence("reports from ", next, " on may be lost from the ledger");
    lose((next / kNumbersKeptFree + 1) * kNumbersKeptFree, lost + ": they may have been sent", now);
    missing += "; " + lost;
  }
  return icd::sentence(all.size(), all.size() == 1 ? " report was read" : " reports were read", missing);
}

void Book::put(const Report& report) {
  Kept& kept = reports_[report.number];
  kept.record = encoded(report, more_of_report(kept.record));
  kept.history += step_of(report);
  highest_ = std::max(highest_, report.number);
}

/// Adds a report that stands for all lost ones up to this number.
void Book::lose(std::int64_t last, const std::string& note, double now) {
  const std::vector<Run> all = runs();
  const auto present = std::ranges::max_element(all, {}, &Run::place);
  put({.number = last,
       .report = {"?", {0, 0, 0}},
       .sender = std::string(Report::kLost),
       .received = now,
       .changed = now,
       .state = ReportState::InDoubt,
       .note = note,
       .run = present->number});
}

}  // namespace adit::ledger
