#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::forward {

/// What the Command Post last said of the run, for clients that ask while Adit cannot ask it, with its age
/// (RFC 9111 5.1).
class KnownStatus {
 public:
  static constexpr std::chrono::seconds kFresh{1};                 // so long it need not be asked again
  static constexpr std::chrono::seconds kOldest{15};               // so long it is better than no answer
  static constexpr std::chrono::seconds kOldestBehindReports{60};  // and so long while reports go first

  /// `body`: JSON.
  void heard(std::string body, loop::Instant asked);
  /// It has changed, or may have: still an answer, but not a fresh one.
  void no_longer_fresh() { fresh_ = false; }

  bool is_fresh(loop::Instant now) const;
  /// Nothing if it is older than `oldest`.
  std::optional<intake::Answer> answer(loop::Instant now, std::chrono::seconds oldest = kOldest) const;

 private:
  std::string body_;
  std::optional<loop::Instant> asked_;
  bool fresh_ = false;
};

}  // namespace adit::forward
