#include "uplink/link_pace.hpp"

#include "uplink/socket.hpp"

namespace adit::uplink {
namespace {

pace::Progress progress_of(int fd, loop::Instant now) {
  const Transmission seen = transmission(fd);
  return {.at = now,
          .delivered = seen.delivered,
          .unsent = seen.unsent,
          .in_flight = seen.in_flight,
          .round_trip = seen.round_trip,
          .least_round_trip = seen.least_round_trip};
}

}  // namespace

void LinkPace::begins(int fd, loop::Instant now) {
  if (!delivery_) return;
  delivery_->begins(progress_of(fd, now));
  told_ = 0;
  tell(fd);
}

void LinkPace::goes_on(int fd, loop::Instant now) {
  if (!delivery_) return;
  delivery_->goes_on(progress_of(fd, now));
  tell(fd);
}

void LinkPace::tell(int fd) {
  const auto pace = static_cast<std::uint64_t>(delivery_->pace());
  if (pace != told_) set_pace(fd, pace);
  told_ = pace;
}

std::uint64_t LinkPace::delivers() const {
  return delivery_ ? static_cast<std::uint64_t>(delivery_->delivers()) : 0;
}

}  // namespace adit::uplink
