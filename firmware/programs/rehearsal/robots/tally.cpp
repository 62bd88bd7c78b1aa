#include "rehearsal/robots/tally.hpp"

#include <algorithm>
#include <cstdio>

namespace adit::robots {
namespace {

using Counts = std::map<std::string, std::uint64_t>;

/// A hostile server may send a new sentence each time.
void count(Counts& counts, const std::string& what) {
  constexpr std::size_t kMost = 50;
  const bool room = counts.contains(what) || counts.size() < kMost;
  ++counts[room ? what : "(others)"];
}

void list(std::string& text, std::string_view title, const Counts& counts) {
  for (const auto& [what, times] : counts) {
    text += std::string(title) + " " + what + " (" + std::to_string(times) + " times)\n";
  }
}

}  // namespace

void Tally::posted(Kind kind) {
  const std::scoped_lock lock(mutex_);
  ++row(kind).posted;
}

void Tally::accepted(Kind kind) {
  const std::scoped_lock lock(mutex_);
  ++row(kind).accepted;
}

void Tally::throttled(Kind kind) {
  const std::scoped_lock lock(mutex_);
  ++row(kind).throttled;
}

void Tally::refused(Kind kind, int status, const std::string& sentence) {
  const std::scoped_lock lock(mutex_);
  ++row(kind).refused;
  count(refusals_, std::string(name_of(kind)) + ": " + std::to_string(status) + " " + sentence);
}

void Tally::unanswered(Kind kind, const std::string& reason) {
  const std::scoped_lock lock(mutex_);
  ++row(kind).unanswered;
  count(silences_, std::string(name_of(kind)) + ": " + reason);
}

void Tally::report_came_to(const std::string& outcome) {
  const std::scoped_lock lock(mutex_);
  count(reports_, outcome);
}

void Tally::failed(const std::string& what) {
  const std::scoped_lock lock(mutex_);
  count(failures_, what);
}

std::uint64_t Tally::accepted_of(Kind kind) const {
  const std::scoped_lock lock(mutex_);
  return rows_[static_cast<std::size_t>(kind)].accepted;
}

bool Tally::clean() const {
  const std::scoped_lock lock(mutex_);
  return failures_.empty() && std::ranges::all_of(rows_, [](const Row& row) { return row.refused == 0; });
}

std::string Tally::line() const {
  const std::scoped_lock lock(mutex_);
  std::string text;
  for (std::size_t i = 0; i < kKinds; ++i) {
    if (rows_[i].posted == 0) continue;
    text += (text.empty() ? "" : ", ") + std::string(name_of(static_cast<Kind>(i))) + " " +
            std::to_string(rows_[i].accepted) + "/" + std::to_string(rows_[i].posted);
  }
  return text;
}

std::string Tally::summary() const {
  const std::scoped_lock lock(mutex_);
  std::string text = "kind         posted  accepted       429  rejected  no answer\n";
  for (std::size_t i = 0; i < kKinds; ++i) {
    const Row& row = rows_[i];
    if (row.posted == 0) continue;
    std::array<char, 96> line{};
    (void)std::snprintf(
        line.data(), line.size(), "%-9s %9llu %9llu %9llu %9llu %10llu\n",
        std::string(name_of(static_cast<Kind>(i))).c_str(), static_cast<unsigned long long>(row.posted),
        static_cast<unsigned long long>(row.accepted), static_cast<unsigned long long>(row.throttled),
        static_cast<unsigned long long>(row.refused), static_cast<unsigned long long>(row.unanswered));
    text += line.data();
  }
  list(text, "rejected:", refusals_);
  list(text, "no answer:", silences_);
  list(text, "reports:", reports_);
  list(text, "failed:", failures_);
  return text;
}

}  // namespace adit::robots
