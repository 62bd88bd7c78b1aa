#pragma once

#include <functional>
#include <map>
#include <vector>

#include "dispatch/output.hpp"

namespace adit::dispatch::model {

/// Power fails.
struct PowerCut {};

/// Keeps written records over a restart, and flushed records over a power cut.
class Disk {
 public:
  struct Content {
    std::map<std::int64_t, Report> reports;
    std::map<std::int64_t, Run> runs;
  };

  bool write(std::span<const Report> steps, const Run* run, bool flushes) {
    if (full) return false;
    cut();
    for (const Report& report : steps) written_.reports[report.number] = report;
    if (run != nullptr) written_.runs[run->number] = *run;
    if (flushes) flush();
    cut();
    return true;
  }
  void flush() { flushed_ = written_; }
  void lose_unflushed() { written_ = flushed_; }

  const Content& content() const { return written_; }
  std::vector<Report> reports() const {
    std::vector<Report> list;
    list.reserve(written_.reports.size());
    for (const auto& [number, report] : written_.reports) list.push_back(report);
    return list;
  }

  std::vector<Run> runs() const {
    std::vector<Run> list;
    list.reserve(written_.runs.size());
    for (const auto& [number, run] : written_.runs) list.push_back(run);
    return list;
  }

  bool full = false;
  std::function<void()> cut = [] {};  // before and after each write; may throw PowerCut

 private:
  Content written_, flushed_;
};

}  // namespace adit::dispatch::model
