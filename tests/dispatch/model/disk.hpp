#pragma once

#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "dispatch/deeds.hpp"

namespace adit::dispatch::model {

/// Thrown where the model's power goes; nothing of the product is on the stack's other side.
struct PowerCut {};

/// A ledger that keeps what was written over every power cut, and nothing else.
class Disk {
 public:
  bool write(std::span<const Report> steps, const Run* run) {
    if (full) return false;
    cut();
    for (const Report& report : steps) reports[report.number] = report;
    if (run != nullptr) last_run = *run;
    cut();
    return true;
  }
  std::vector<Report> all() const {
    std::vector<Report> list;
    for (const auto& [number, report] : reports) list.push_back(report);
    return list;
  }

  bool full = false;
  std::function<void()> cut = [] {};  // may throw PowerCut: before and after each write
  std::map<std::int64_t, Report> reports;
  std::optional<Run> last_run;
};

}  // namespace adit::dispatch::model
