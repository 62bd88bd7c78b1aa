#include "intake/deadline.hpp"

#include <algorithm>
#include <utility>

#include "intake/engine.hpp"

namespace adit::intake {
namespace {

/// How long libmicrohttpd may take to read the last bytes of a client that has closed its direction.
constexpr std::chrono::milliseconds kAfterEnd(100);
constexpr std::chrono::seconds kLastReading(2);

}  // namespace

void Deadline::expect_bytes(std::chrono::milliseconds within) {
  expect_nothing();
  bytes_expected_ = true;
  set(engine_.now() + (ended_ ? std::min(within, kAfterEnd) : within));
}

void Deadline::expect_last_reading() {
  expect_nothing();
  set(engine_.now() + kLastReading);
}

void Deadline::expect_head() {
  expect_bytes(authenticated_ ? engine_.listen().rate_over : engine_.listen().unauthenticated_within);
}

void Deadline::expect_body() {
  expect_bytes(engine_.listen().unauthenticated_within);
  if (authenticated_ && !ended_) expect_rate();
}

void Deadline::body_came(std::size_t bytes) {
  if (rate_) rate_->moved(bytes);
}

void Deadline::expect_steady_reading(std::uint64_t taken) {
  expect_nothing();
  taken_before_ = taken;
  expect_rate();
}

void Deadline::expect_nothing() {
  bytes_expected_ = false;
  rate_.reset();
  at_ = loop::Instant::max();
}

void Deadline::client_ended() {
  if (!std::exchange(ended_, true) && bytes_expected_) expect_bytes(kAfterEnd);
}

bool Deadline::is_late() {
  if (bytes_expected_ && ended_ && gate_.unread() > 0) {
    expect_bytes(kAfterEnd);
    return false;
  }
  if (keeps_up()) return false;
  expect_nothing();
  return true;
}

bool Deadline::keeps_up() {
  if (!rate_) return false;
  if (!bytes_expected_) {
    const std::uint64_t before = std::exchange(taken_before_, gate_.traffic().taken);
    rate_->moved(taken_before_ - before);
  }
  if (rate_->is_too_slow(engine_.now())) return false;
  set(rate_->look_at());
  return true;
}

void Deadline::expect_rate() {
  rate_.emplace(engine_.listen().rate_over, engine_.now());
  set(rate_->look_at());
}

void Deadline::set(loop::Instant when) {
  at_ = when;
  engine_.look_at(at_);
}

}  // namespace adit::intake
