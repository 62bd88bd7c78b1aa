#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "panel/button.hpp"
#include "panel/lines.hpp"

namespace adit::panel {

/// Sets the lights when they change, retries after a failure, and sets them now and then, because only that
/// shows a vanished chip. It reads no clock: each call gets the time, which never runs backward.
class Painter {
 public:
  static constexpr Milliseconds kAgain{500};     // after a failure
  static constexpr Milliseconds kConfirm{2000};  // after a success
  /// Trouble ends after this time without a failure, so that a loose contact is reported once.
  static constexpr Milliseconds kMended{5000};

  /// Null: no lines. The next show() sets the new lines.
  void set_lines(std::unique_ptr<Lines> lines) {
    lines_ = std::move(lines);
    tried_.reset();
    trouble_.clear();
  }
  const Lines* lines() const { return lines_.get(); }

  /// Sets the lights if they have changed or setting is due.
  void show(const Lit& lit, Instant now) {
    if (tried_ != lit || now >= due_) set(lit, now);
  }
  /// Sets the lights in any case.
  void set(const Lit& lit, Instant now) {
    if (!lines_) return;
    tried_ = lit;
    const auto done = lines_->set(lit);
    due_ = now + (done ? kConfirm : kAgain);
    if (!done) {
      trouble_ = done.error();
      well_since_ = due_;  // at the earliest
    } else if (now - well_since_ >= kMended) {
      trouble_.clear();
    }
  }
  /// When show() is due if the lights do not change; nullopt: there are no lines.
  std::optional<Instant> next() const { return lines_ ? std::optional(due_) : std::nullopt; }

  /// True if these lines have not been set yet.
  bool is_blank() const { return !tried_; }
  /// Why the lights may be wrong, or "".
  const std::string& trouble() const { return trouble_; }
  /// True if trouble() began or ended since the last call.
  bool has_turned() {
    const bool is_in_trouble = !trouble_.empty();
    return std::exchange(was_in_trouble_, is_in_trouble) != is_in_trouble;
  }

 private:
  std::unique_ptr<Lines> lines_;
  std::optional<Lit> tried_;
  Instant due_{}, well_since_{};
  std::string trouble_;
  bool was_in_trouble_ = false;
};

}  // namespace adit::panel
