#include "uplink/connections.hpp"

#include <utility>

#include "icd/require.hpp"

namespace adit::uplink {

Connections::Connections(loop::Loop& loop, Endpoint endpoint, icd::BearerToken token,
                         std::shared_ptr<Server> server, std::function<void()> turn_came)
    : server_(std::move(server)),
      turn_{.came = std::move(turn_came)},
      first_(loop, std::move(endpoint), std::move(token), server_) {
  server_->add(turn_);
}

void Connections::hurry() {
  first_.hurry();
  if (second_) second_->hurry();
}

/// Null if no request is in flight, or two.
const Connection* Connections::the_busy_one() const {
  const bool is_second = second_ && second_->busy();
  if (first_.busy()) return is_second ? nullptr : &first_;
  return is_second ? second_.get() : nullptr;
}

Connection* Connections::other_than(const Connection& one) {
  return &one == &first_ ? second_.get() : &first_;
}

void Connections::get_ready() {
  const Connection* const busy = the_busy_one();
  if (busy == nullptr || std::exchange(has_tried_, true)) return;
  if (!second_) second_ = first_.another();
  other_than(*busy)->open();
}

bool Connections::is_ready() const {
  const Connection* const busy = the_busy_one();
  return busy != nullptr && (busy == &first_ ? second_ && second_->connected() : first_.connected());
}

std::optional<Sent> Connections::has_arrived() const {
  const Connection* const busy = the_busy_one();
  return busy == nullptr ? std::nullopt : busy->has_arrived();
}

/// If both connections are idle, at most one is open.
Connection& Connections::one_for_the_next() {
  if (const Connection* const busy = the_busy_one()) return *other_than(*busy);
  return second_ && second_->connected() ? *second_ : first_;
}

void Connections::send(Request request, std::function<void(Outcome)> done) {
  icd::require(!busy() || is_ready());
  Connection& one = one_for_the_next();
  request.goes_ahead = busy();
  one.send(std::move(request), [this, &one, done = std::move(done)](Outcome outcome) {
    ended(one);
    done(std::move(outcome));  // may destroy this object
  });
  latest_ = &one;
  has_tried_ = false;
}

void Connections::ended(Connection& one) {
  Connection* const other = other_than(one);
  if (other == nullptr) return;
  if (!other->busy()) return other->close();
  one.close();
  other->is_next();
}

}  // namespace adit::uplink
