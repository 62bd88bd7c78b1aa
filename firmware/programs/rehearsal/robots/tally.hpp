#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>

#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

/// What was posted and what came of it. Any thread may write to it.
class Tally {
 public:
  void posted(Kind kind);
  void accepted(Kind kind);
  /// 429: the team went too fast, which is normal.
  void throttled(Kind kind);
  /// Any other refusal.
  void refused(Kind kind, int status, const std::string& sentence);
  /// No answer came, for `reason`.
  void unanswered(Kind kind, const std::string& reason);
  /// What an answered report came to: "scored +1", "run not started", ...
  void report_came_to(const std::string& outcome);
  /// Something of the team's own that is wrong, such as a map file.
  void failed(const std::string& what);

  std::uint64_t accepted_of(Kind kind) const;

  /// Whether nothing was refused but by 429, and nothing failed.
  bool clean() const;

  /// "grid 12/12, cloud 9/12, ...": accepted of posted, for a line that lives.
  std::string line() const;

  /// Lines for a person: a row for each kind, then each refusal, then the reports.
  std::string summary() const;

 private:
  struct Row {
    std::uint64_t posted = 0, accepted = 0, throttled = 0, refused = 0, unanswered = 0;
  };
  Row& row(Kind kind) { return rows_[static_cast<std::size_t>(kind)]; }

  mutable std::mutex mutex_;  // guards all below
  std::array<Row, kKinds> rows_{};
  std::map<std::string, std::uint64_t> refusals_;  // "markers: 422 ..."
  std::map<std::string, std::uint64_t> silences_;
  std::map<std::string, std::uint64_t> reports_;
  std::map<std::string, std::uint64_t> failures_;
};

}  // namespace adit::robots
