#include "panel/painter.hpp"

#include <utility>

namespace adit::panel {

void Painter::take(std::unique_ptr<Lines> lines) {
  lines_ = std::move(lines);
  tried_.reset();
  trouble_.clear();
}

void Painter::set(const Lit& lit, Instant now) {
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

}  // namespace adit::panel
