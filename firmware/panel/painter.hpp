#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "panel/button.hpp"
#include "panel/lines.hpp"

namespace adit::panel {

/// Sets lines when what is to be lit changes, again when that could not be done, and now and then in any
/// case: a chip that has vanished says so only where it is set. It knows no clock: each call says what time
/// it is, and times never run backward.
class Painter {
 public:
  static constexpr Milliseconds kAgain{500};     // after a try that failed
  static constexpr Milliseconds kConfirm{2000};  // after one that went well
  /// So long all must have gone well before trouble is over: a loose contact is told of once.
  static constexpr Milliseconds kMended{5000};

  /// Null: there are none. What is to be lit is shown next.
  void take(std::unique_ptr<Lines> lines);
  const Lines* lines() const { return lines_.get(); }

  /// Sets what is to be lit, where that is due.
  void show(const Lit& lit, Instant now);
  /// In any case.
  void set(const Lit& lit, Instant now);
  /// When show() is due where nothing changes; nothing: never.
  std::optional<Instant> next() const;

  /// Nothing was shown on these lines yet.
  bool is_blank() const { return !tried_; }
  /// Why the lines may not show what they were last set to; or "".
  const std::string& trouble() const { return trouble_; }
  /// Whether trouble() came or went since this was last asked.
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
