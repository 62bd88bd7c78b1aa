#include "alarms/growth.hpp"

#include <algorithm>

namespace adit::alarms {

void Growth::look(std::size_t bytes, std::size_t room, double now) {
  if (!begun_ || now - step_at_ >= kStep) {
    begun_ = true;
    step_at_ = now;
    least_.push_back(bytes);
    if (least_.size() > kSteps + 1) least_.pop_front();
    const bool rises = least_.size() > kSteps && std::ranges::is_sorted(least_, std::ranges::less_equal{});
    if (rises && static_cast<double>(bytes) > kTelling * static_cast<double>(room)) {
      grew_ = true;
      last_ = now;
    }
  }
  least_.back() = std::min(least_.back(), bytes);
}

}  // namespace adit::alarms
