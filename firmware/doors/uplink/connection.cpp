#include "uplink/connection.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "icd/require.hpp"

namespace adit::uplink {

std::string authority_of(const Endpoint& endpoint) {
  // A zone ("fe80::1%darpa0") has a meaning on this machine only (RFC 6874 4).
  const std::string address = endpoint.address.substr(0, endpoint.address.find('%'));
  const bool is_ipv6 = address.find(':') != std::string::npos;
  return (is_ipv6 ? "[" + address + "]" : address) + ":" + std::to_string(endpoint.port);
}

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

void LinkPace::on_write_begun(int fd, loop::Instant now) {
  if (!delivery_) return;
  delivery_->on_write_begun(progress_of(fd, now));
  told_ = 0;
  apply_pace(fd);
}

void LinkPace::on_write(int fd, loop::Instant now) {
  if (!delivery_) return;
  delivery_->on_write(progress_of(fd, now));
  apply_pace(fd);
}

void LinkPace::apply_pace(int fd) {
  const auto pace = static_cast<std::uint64_t>(delivery_->pace());
  if (pace != told_) set_pace(fd, pace);
  told_ = pace;
}

std::uint64_t LinkPace::delivery_rate() const {
  return delivery_ ? static_cast<std::uint64_t>(delivery_->delivery_rate()) : 0;
}

void Connection::keep_warm() {
  warm_ = true;
  return_warm();
}

void Connection::retry_now() {
  attempts_.retry_now();
  if (is_connected() || (!socket_ && !keeps_idle())) return;
  close_socket();
  connect();
}

void Connection::close() {
  icd::require(!busy());
  if (socket_) drop();
}

bool Connection::keeps_idle() const {
  return warm_ && server_->can_keep_idle();
}

void Connection::connect() {
  attempts_.on_begun(loop_.now());
  auto fd = begin_connect(endpoint_);
  if (!fd) return on_connect_failed(fd.error().why);
  timer_.call_at(loop_.now() + endpoint_.connect_within);
  socket_.emplace(std::move(*fd));
  socket_->source = loop_.watch(socket_->fd.get(), EPOLLOUT, [this](std::uint32_t) { on_socket_ready(); });
}

/// Connects an idle connection now, or when the pause since the last attempt is over.
void Connection::return_warm() {
  if (!keeps_idle() || socket_ || exchange_) return;
  if (attempts_.next() <= loop_.now()) return connect();
  timer_.call_at(attempts_.next());
}

void Connection::on_connect_result(int error) {
  if (error != 0) return on_connect_failed(std::strerror(error));
  socket_->is_open = true;
  socket_->idle_since = loop_.now();
  socket_->is_fresh = exchange_ != nullptr;
  socket_->sent_twice = transmission(socket_->fd.get()).sent_twice;
  attempts_.on_succeeded();
  if (exchange_) return begin();
  rest();
}

void Connection::on_connect_failed(const std::string& why) {
  const loop::Instant next =
      attempts_.on_failed("connecting to " + authority_of(endpoint_) +
                          (endpoint_.interface.empty() ? "" : " by " + endpoint_.interface) + ": " + why);
  close_socket();
  if (keeps_idle()) timer_.call_at(next);
  if (exchange_) deliver(NeverSent{trouble()});
}

/// Waits for the next request, and closes an idle connection before the peer does.
void Connection::rest() {
  socket_->source.wait_for(kComing);
  timer_.call_at(loop_.now() + kIdle);
}

/// The connection was idle for kIdle, the peer closed it, or the peer sent bytes without a request. Closes it
/// before it connects again, because some servers serve one connection at a time.
void Connection::on_idle_ended() {
  close_socket();
  return_warm();
}

void Connection::drop() {
  close_socket();
  if (keeps_idle()) timer_.call_at(std::max(loop_.now(), attempts_.next()));
}

void Connection::close_socket() {
  socket_.reset();
  timer_.cancel();
  server_->on_close();
}

Connection::Connection(loop::Loop& loop, Endpoint endpoint, icd::BearerToken token,
                       std::shared_ptr<Server> server, std::shared_ptr<LinkPace> pace)
    : loop_(loop),
      endpoint_(std::move(endpoint)),
      token_(std::move(token)),
      server_(std::move(server)),
      pace_(std::move(pace)) {
  server_->add(*this);
  silence_ = loop_.timer([this] { check_silence(); });
  timer_ = loop_.timer([this] { on_timer(); });
  tell_ = loop_.timer([this] { report_outcome(); });
  look_ = loop_.timer([this] { update_pace(); });
}

Connection::Connection(loop::Loop& loop, Endpoint endpoint, icd::BearerToken token,
                       std::shared_ptr<Server> server)
    : Connection(loop, endpoint, std::move(token),
                 server ? std::move(server) : std::make_shared<Server>(loop),
                 std::make_shared<LinkPace>(endpoint.bytes_per_second)) {}

std::unique_ptr<Connection> Connection::another() const {
  return std::unique_ptr<Connection>(new Connection(loop_, endpoint_, token_, server_, pace_));
}

Connection::~Connection() {
  warm_ = false;  // so that no attempt to connect follows
  give_up();
  server_->remove(*this);
}

void Connection::send(Request request, std::function<void(Outcome)> done) {
  icd::require(!busy());
  exchange_ = std::make_unique<Exchange>(endpoint_, token_, std::move(request));
  done_ = std::move(done);
  sent_ = 0;
  wait_ = {.since = loop_.now()};
  within_send_ = true;
  begin_sending();
  within_send_ = false;
}

void Connection::give_up() {
  done_ = nullptr;
  outcome_.reset();
  if (exchange_) sent_ = exchange_->sent_bytes();
  exchange_.reset();
  if (socket_) drop();
}

void Connection::begin_sending() {
  silence_.call_at(loop_.now() + kLookForSilence);
  open();
  if (is_connected() && exchange_) begin();
}

void Connection::on_socket_ready() {
  if (!is_connected()) return on_connect_result(connect_error(socket_->fd.get()));
  if (!exchange_) return on_idle_ended();
  if (read_answer()) return;
  if (exchange_->wants_to_write()) write();
}

void Connection::on_timer() {
  if (!socket_) return return_warm();
  if (!is_connected()) return on_connect_failed("no answer in time");
  if (!exchange_) return on_idle_ended();
  if (read_answer()) return;
  exchange_->listen(socket_->fd.get(), loop_.now());
  if (exchange_->is_silent_at(loop_.now()))
    return on_in_doubt({.why = exchange_->sentence("the peer was silent for too long")});
  const bool has_more = exchange_->release(loop_.now());
  schedule_listening();
  if (has_more) write();
}

/// An idle connection cannot block one that the server has answered before.
void Connection::check_silence() {
  if (!exchange_ || wait_.is_silent || (is_connected() && socket_->is_served)) return;
  loop::Instant silent_at = wait_.since + Server::kSilence;
  if (is_connected()) {
    exchange_->listen(socket_->fd.get(), loop_.now());
    silent_at = exchange_->silence_start() + Server::kSilence;
  }
  if (silent_at > loop_.now())
    return silence_.call_at(std::min<loop::Instant>(silent_at, loop_.now() + kLookForSilence));
  wait_.is_silent = true;
  server_->on_silence();
}

/// Updates the pace while the kernel's buffer is full.
void Connection::update_pace() {
  if (!exchange_ || !is_connected() || !exchange_->wants_to_write()) return;
  pace_->on_write(socket_->fd.get(), loop_.now());
  look_.call_at(loop_.now() + LinkPace::kLook);
}

void Connection::begin() {
  // The peer may have closed a kept connection, or a new one at once. No byte of this request was sent, so
  // NeverSent is true, and a retry on a new connection is safe.
  if (!is_quiet(socket_->fd.get()))
    return socket_->is_fresh
               ? deliver_never_sent("the peer closed the new connection, or sent bytes before the request")
               : retry_request();
  give_up_after(socket_->fd.get(), exchange_->longest_silence());
  // A request that is given up must not arrive after the next request on another connection, and must not be
  // recorded later.
  reset_on_close(socket_->fd.get(), true);
  exchange_->begin(loop_.now(), socket_->sent_twice);
  schedule_listening();
  write();
}

void Connection::retry_request() {
  close_socket();
  connect();
}

void Connection::write() {
  const bool begins = exchange_->sent_bytes() == 0;
  if (!begins) pace_->on_write(socket_->fd.get(), loop_.now());
  const int error = exchange_->write(socket_->fd.get());
  if (begins) on_first_write();
  if (error == 0) return socket_->source.wait_for(exchange_->wants_to_write() ? kComing | EPOLLOUT : kComing);
  if (exchange_->sent_bytes() == 0)
    return socket_->is_fresh ? deliver_never_sent(std::strerror(error)) : retry_request();
  if (!read_answer()) socket_->source.wait_for(kComing);
}

void Connection::on_first_write() {
  exchange_->on_first_write(loop_.now());
  if (!exchange_->wants_to_write()) return;  // too short to measure the link
  pace_->on_write_begun(socket_->fd.get(), loop_.now());
  look_.call_at(loop_.now() + LinkPace::kLook);
}

/// Reads. True if that ended the exchange.
bool Connection::read_answer() {
  switch (exchange_->read(socket_->fd.get())) {
    case Exchange::Answer::Waiting:
      if (exchange_->is_early()) schedule_listening();
      return false;
    case Exchange::Answer::Lost:
      on_in_doubt(exchange_->doubt());
      return true;
    case Exchange::Answer::Whole:
      on_answered();
      return true;
  }
  return false;
}

void Connection::on_earlier_request_ended() {
  if (!exchange_) return;
  exchange_->on_earlier_request_ended(loop_.now());
  if (is_connected()) schedule_listening();
}

std::optional<SendTimes> Connection::has_arrived() const {
  if (!exchange_ || !is_connected() || !exchange_->has_arrived(socket_->fd.get())) return {};
  return exchange_->sent_times(transmission(socket_->fd.get()), loop_.now());
}

void Connection::on_answered() {
  Answered answer = exchange_->take_answer();
  const Transmission seen = transmission(socket_->fd.get());
  answer.sent = exchange_->sent_times(seen, loop_.now());
  reset_on_close(socket_->fd.get(), exchange_->sent_bytes() < exchange_->total());
  // The measured mapping server promises keep-alive with a 4xx and still closes.
  const bool keep = server_->on_answer(*this, exchange_->can_keep_alive() && answer.status < 400);
  if (keep) {
    socket_->is_fresh = false;
    socket_->sent_twice = seen.sent_twice;
    rest();
  } else {
    drop();
  }
  token_.strike_from(answer.body);  // a server may echo the request
  deliver(std::move(answer));
}

void Connection::on_in_doubt(InDoubt doubt) {
  drop();
  deliver(std::move(doubt));
}

void Connection::deliver_never_sent(const std::string& reason) {
  std::string why = exchange_->sentence(reason);
  drop();
  deliver(NeverSent{std::move(why)});
}

/// Ends the exchange. Calls `done` last, because it may send the next request.
void Connection::deliver(Outcome outcome) {
  sent_ = exchange_->sent_bytes();
  exchange_.reset();
  if (!within_send_) return call_done(std::move(outcome));
  outcome_ = std::move(outcome);
  tell_.call_at(loop_.now());
}

void Connection::report_outcome() {
  if (auto outcome = std::exchange(outcome_, std::nullopt)) call_done(std::move(*outcome));
}

void Connection::call_done(Outcome outcome) {
  if (const auto done = std::exchange(done_, nullptr)) done(std::move(outcome));
}

Server::Server(loop::Loop& loop) : loop_(loop), wake_(loop.timer([this] { wake(); })) {}

bool Server::is_free() const {
  return !is_serial_ ||
         std::ranges::none_of(connections_, [](const Connection* each) { return each->socket_.has_value(); });
}

bool Server::claim(Turn& turn, bool goes_first) {
  if (!is_serial_) return true;
  turn.is_claimed = true;
  turn.goes_first = goes_first;
  if (!is_free()) return false;
  wake_.call_at(loop_.now());  // in case it sends nothing, or another one is next
  if (next_turn() != &turn) return false;
  turn.is_claimed = false;
  turn.last = loop_.now();
  return true;
}

/// Null if none is claimed.
Server::Turn* Server::next_turn() const {
  Turn* next = nullptr;
  for (Turn* const each : turns_) {
    if (!each->is_claimed) continue;
    if (next == nullptr ||
        std::pair(!each->goes_first, each->last) < std::pair(!next->goes_first, next->last))
      next = each;
  }
  return next;
}

void Server::on_silence() {
  if (is_serial_) return;
  cleared_until_ = loop_.now() + kSilence;
  wake_.call_at(cleared_until_);
  close_idle();
}

void Server::close_idle() {
  for (Connection* const each : connections_) {
    if (!each->socket_ || each->exchange_) continue;
    suspect(*each);
    each->close_socket();
  }
}

/// The connection ends without a request. It may have blocked the silent ones.
void Server::suspect(const Connection& closed) {
  if (!closed.is_connected() || closed.socket_->is_passed) return;
  const loop::Instant answer_by = loop_.now() + (closed.socket_->is_served ? kSilence : kAtOnce);
  for (Connection* const each : connections_) {
    if (each->is_silent() && !each->wait_.answer_by) each->wait_.answer_by = answer_by;
  }
}

bool Server::on_answer(Connection& one, bool can_stay) {
  const loop::Instant now = loop_.now();
  for (Connection* const each : connections_) {
    if (each == &one || !each->is_connected() || !is_quiet(each->socket_->fd.get())) continue;
    if (each->socket_->idle_since >= one.wait_.since) continue;
    each->socket_->is_passed = true;
    helped_ = 0;
  }
  const Connection::Wait wait = std::exchange(one.wait_, {});
  const bool is_helped = wait.answer_by && now <= *wait.answer_by && wait.since >= helped_at_;
  if (is_helped) helped_at_ = now;
  if (is_helped && ++helped_ == 2) begin_serial();
  if (!can_stay || is_serial_) return false;
  one.socket_->idle_since = now;
  one.socket_->is_served = true;
  one.socket_->is_passed = false;
  if (std::ranges::none_of(connections_, [](const Connection* each) { return each->is_silent(); }))
    return true;
  suspect(one);
  return false;
}

void Server::begin_serial() {
  is_serial_ = true;
  helped_ = 0;
  try_again_at_ = loop_.now() + kTryAgain;
  close_idle();
  on_close();
}

/// Connects warm connections and lets senders send. They may destroy connections and turns.
void Server::wake() {
  const auto alive = shared_from_this();
  if (is_serial_ && loop_.now() >= try_again_at_) is_serial_ = false;
  if (is_serial_) {
    wake_.call_at(try_again_at_);
  } else {
    for (Connection* const each : connections_) each->return_warm();
  }
  while (is_free()) {
    Turn* const next = next_turn();
    if (next == nullptr) return;
    next->is_claimed = false;
    next->on_turn();
  }
}

std::shared_ptr<Server> Servers::at(const Endpoint& endpoint) {
  std::erase_if(servers_, [](const auto& each) { return each.second.expired(); });
  auto& known = servers_[{endpoint.address, endpoint.port}];
  auto server = known.lock();
  if (!server) known = server = std::make_shared<Server>(loop_);
  return server;
}

Connections::Connections(loop::Loop& loop, Endpoint endpoint, icd::BearerToken token,
                         std::shared_ptr<Server> server, std::function<void()> turn_came)
    : server_(std::move(server)),
      turn_{.on_turn = std::move(turn_came)},
      first_(loop, std::move(endpoint), std::move(token), server_) {
  server_->add(turn_);
}

void Connections::retry_now() {
  first_.retry_now();
  if (second_) second_->retry_now();
}

/// Null if no request is in flight, or two.
const Connection* Connections::busy_connection() const {
  const bool is_second = second_ && second_->busy();
  if (first_.busy()) return is_second ? nullptr : &first_;
  return is_second ? second_.get() : nullptr;
}

void Connections::preconnect() {
  const Connection* const busy = busy_connection();
  if (busy == nullptr || std::exchange(has_tried_, true)) return;
  if (!second_) second_ = first_.another();
  peer_of(*busy)->open();
}

bool Connections::is_ready() const {
  const Connection* const busy = busy_connection();
  return busy != nullptr && (busy == &first_ ? second_ && second_->is_connected() : first_.is_connected());
}

std::optional<SendTimes> Connections::has_arrived() const {
  const Connection* const busy = busy_connection();
  return busy == nullptr ? std::nullopt : busy->has_arrived();
}

/// If both connections are idle, at most one is open.
Connection& Connections::select_connection() {
  if (const Connection* const busy = busy_connection()) return *peer_of(*busy);
  return second_ && second_->is_connected() ? *second_ : first_;
}

void Connections::send(Request request, std::function<void(Outcome)> done) {
  icd::require(!busy() || is_ready());
  Connection& one = select_connection();
  request.goes_ahead = busy();
  one.send(std::move(request), [this, &one, done = std::move(done)](Outcome outcome) {
    on_ended(one);
    done(std::move(outcome));  // may destroy this object
  });
  latest_ = &one;
  has_tried_ = false;
}

void Connections::on_ended(Connection& one) {
  Connection* const other = peer_of(one);
  if (other == nullptr) return;
  if (!other->busy()) return other->close();
  one.close();
  other->on_earlier_request_ended();
}

}  // namespace adit::uplink
