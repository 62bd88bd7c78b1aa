#include "uplink/connection.hpp"

#include <sys/epoll.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "icd/require.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/guard.hpp"
#include "uplink/exchange.hpp"
#include "uplink/socket.hpp"

namespace adit::uplink {
namespace {

/// A connection that is kept warm is begun at most this often, and less often while it fails.
constexpr std::chrono::seconds kFirstPause{1}, kLongestPause{5};

constexpr std::uint32_t kComing = EPOLLIN | EPOLLRDHUP;

}  // namespace

/// Callbacks hold the Impl while they run: `done` may destroy the Connection.
class Connection::Impl : public std::enable_shared_from_this<Impl> {
 public:
  Impl(loop::Loop& loop, Endpoint endpoint, icd::BearerToken token)
      : loop_(loop), endpoint_(std::move(endpoint)), token_(std::move(token)) {
    timer_ = loop_.timer([this] { guard(&Impl::time_came); });
    tell_ = loop_.timer([this] { guard(&Impl::tell); });
  }

  void keep_warm() {
    warm_ = true;
    if (phase_ == Phase::Closed) connect_in_time();
  }

  void hurry() {
    const auto alive = shared_from_this();
    pause_ = kFirstPause;
    if (phase_ == Phase::Connecting) {
      close();
      connect();
    } else if (phase_ == Phase::Closed && warm_) {
      connect();
    }
  }

  void send(Request request, std::function<void(Outcome)> done) {
    icd::require(!busy());
    InDoubt undealt{.why = "what the peer sent could not be dealt with"};
    auto exchange = std::make_unique<Exchange>(endpoint_, token_, std::move(request));
    undealt_ = std::move(undealt);
    exchange_ = std::move(exchange);
    done_ = std::move(done);
    sent_ = 0;
    within_send_ = true;
    guard(&Impl::begin_sending);
    within_send_ = false;
  }

  /// The Connection is gone, though a callback may still hold this.
  void abandon() {
    warm_ = false;
    done_ = nullptr;
    exchange_.reset();
    timer_ = {};
    tell_ = {};
    close();
  }

  bool busy() const { return done_ != nullptr; }
  bool connected() const { return phase_ == Phase::Open; }
  const std::string& trouble() const { return trouble_; }
  std::size_t sent_bytes() const { return exchange_ ? exchange_->sent() : sent_; }

 private:
  enum class Phase : std::uint8_t { Closed, Connecting, Open };

  /// Calls one of its own parts. What throws there ends the request under way, of which bytes may have left,
  /// and the connection. That takes no memory, for there may be none.
  void guard(void (Impl::*part)()) {
    const auto alive = shared_from_this();
    if (loop::guarded("a connection to the Command Post", [&] { (this->*part)(); })) return;
    if (!exchange_) return drop();
    loop::guarded("the loss of an answer", [&] { in_doubt(std::move(undealt_)); });
  }

  void begin_sending() {
    if (phase_ == Phase::Closed) connect();
    if (phase_ == Phase::Open && exchange_) begin();
  }

  // What the socket and the timer call.

  void ready() {
    if (phase_ == Phase::Connecting) return connecting_ended(connect_error(fd_.get()));
    if (!exchange_) return idle_ended();
    if (answer_came()) return;
    if (exchange_->wants_to_write()) write();
  }

  void time_came() {
    if (phase_ == Phase::Closed) return connect();
    if (phase_ == Phase::Connecting) return connecting_failed("no answer in time");
    if (!exchange_) return idle_ended();
    exchange_->listen(fd_.get(), loop_.now());
    if (exchange_->is_silent_at(loop_.now()))
      return in_doubt({.why = exchange_->sentence("the peer was silent for too long")});
    const bool has_more = exchange_->release(loop_.now());
    listen_again();
    if (has_more) write();
  }

  // Connecting.

  void connect() {
    began_ = loop_.now();
    auto fd = begin_connect(endpoint_);
    if (!fd) return connecting_failed(fd.error().why);
    fd_ = std::move(*fd);
    gives_up_after_ = {};
    phase_ = Phase::Connecting;
    watched_ = EPOLLOUT;
    timer_.call_at(began_ + endpoint_.connect_within);
    source_ = loop_.watch(fd_.get(), watched_, [this](std::uint32_t) { guard(&Impl::ready); });
  }

  /// Now, or when the pause since the last time is over.
  void connect_in_time() {
    const loop::Instant when = began_ + pause_;
    if (when <= loop_.now()) return connect();
    timer_.call_at(when);
  }

  void connecting_ended(int error) {
    if (error != 0) return connecting_failed(std::strerror(error));
    phase_ = Phase::Open;
    trouble_.clear();
    pause_ = kFirstPause;
    fresh_ = exchange_ != nullptr;
    if (exchange_) return begin();
    rest();
  }

  void connecting_failed(const std::string& why) {
    trouble_ = "connecting to " + authority_of(endpoint_) +
               (endpoint_.interface.empty() ? "" : " by " + endpoint_.interface) + ": " + why;
    close();
    const auto pause = std::exchange(pause_, std::min<std::chrono::seconds>(pause_ * 2, kLongestPause));
    if (warm_) timer_.call_at(began_ + pause);
    if (exchange_) deliver(NeverSent{trouble_});
  }

  // Idle.

  /// Waits for the next request: an idle connection is given up before the peer does.
  void rest() {
    watch(kComing);
    timer_.call_at(loop_.now() + kIdle);
  }

  /// It has been idle for long enough, or the peer closed it, or sent what nobody asked for. The old
  /// connection goes before the new one comes, for the sake of servers that serve one connection at a time.
  void idle_ended() {
    close();
    if (warm_) connect_in_time();
  }

  // A request and its answer.

  void begin() {
    // The peer may have closed a kept connection meanwhile, or a new one at once. Nothing of this request has
    // been sent, so that it is still safe to say so, or to try once more.
    if (!is_quiet(fd_.get()))
      return fresh_ ? never_sent("the peer closed the new connection, or spoke first") : begin_again();
    if (std::exchange(gives_up_after_, exchange_->answer_within()) != exchange_->answer_within()) {
      give_up_after(fd_.get(), exchange_->answer_within());
    }
    // What is given up must not arrive after what follows it on another connection, nor be recorded unseen.
    reset_on_close(fd_.get(), true);
    exchange_->begin(fd_.get(), loop_.now());
    listen_again();
    write();
  }

  void begin_again() {
    close();
    connect();
  }

  void write() {
    const bool begins = exchange_->sent() == 0;
    const int error = exchange_->write(fd_.get());
    if (begins) exchange_->began_to_leave(loop_.now());
    if (error == 0) return watch(exchange_->wants_to_write() ? kComing | EPOLLOUT : kComing);
    if (exchange_->sent() == 0) return fresh_ ? never_sent(std::strerror(error)) : begin_again();
    if (!answer_came()) watch(kComing);
  }

  /// Reads; true where that ended the exchange.
  bool answer_came() {
    switch (exchange_->read(fd_.get())) {
      case Exchange::Answer::Waiting:
        return false;
      case Exchange::Answer::Lost:
        in_doubt(exchange_->doubt());
        return true;
      case Exchange::Answer::Whole:
        answered();
        return true;
    }
    return false;
  }

  void listen_again() { timer_.call_at(exchange_->next_listening(loop_.now())); }

  void answered() {
    Answered answer = exchange_->take_answer();
    const Transmission seen = transmission(fd_.get());
    answer.sent = exchange_->left(seen, loop_.now());
    reset_on_close(fd_.get(), exchange_->sent() < exchange_->total());
    // The measured mapping server promises keep-alive with a 4xx and closes all the same.
    const bool keep = exchange_->may_keep_alive() && answer.status < 400;
    if (keep) {
      fresh_ = false;
      rest();
    } else {
      drop();
    }
    token_.strike_from(answer.body);  // a server that echoes what it was asked
    deliver(std::move(answer));
  }

  void in_doubt(InDoubt doubt) {
    drop();
    deliver(std::move(doubt));
  }

  void never_sent(const std::string& reason) {
    std::string why = exchange_->sentence(reason);
    drop();
    deliver(NeverSent{std::move(why)});
  }

  // Ends.

  /// Ends the exchange. `done` is called last, for it may send the next request or destroy all this.
  void deliver(Outcome outcome) {
    sent_ = exchange_->sent();
    exchange_.reset();
    if (!within_send_) return call_done(std::move(outcome));
    outcome_ = std::move(outcome);
    tell_.call_at(loop_.now());
  }

  void tell() {
    if (auto outcome = std::exchange(outcome_, std::nullopt)) call_done(std::move(*outcome));
  }

  void call_done(Outcome outcome) {
    if (const auto done = std::exchange(done_, nullptr)) done(std::move(outcome));
  }

  void drop() {
    close();
    if (warm_) timer_.call_at(std::max(loop_.now(), began_ + pause_));
  }

  void close() {
    source_ = {};
    fd_ = {};
    phase_ = Phase::Closed;
    if (timer_) timer_.cancel();
  }

  void watch(std::uint32_t events) {
    if (std::exchange(watched_, events) != events) source_.wait_for(events);
  }

  loop::Loop& loop_;
  const Endpoint endpoint_;
  const icd::BearerToken token_;

  Phase phase_ = Phase::Closed;
  loop::FileDescriptor fd_;
  std::chrono::milliseconds gives_up_after_{};  // as fd_ was told; 0: not yet
  loop::Source source_;                         // of fd_; ends before it
  std::uint32_t watched_ = 0;
  loop::Source timer_;  // the end of the phase: a pause, connecting, resting, the peer's silence
  bool warm_ = false;
  bool fresh_ = false;   // connected for the very request that is under way
  loop::Instant began_;  // to connect, last
  std::chrono::seconds pause_ = kFirstPause;
  std::string trouble_;

  std::unique_ptr<Exchange> exchange_;
  std::function<void(Outcome)> done_;
  bool within_send_ = false;
  InDoubt undealt_;                 // for guard()
  std::optional<Outcome> outcome_;  // known within send(), to be told after it
  loop::Source tell_;
  std::size_t sent_ = 0;
};

Connection::Connection(loop::Loop& loop, Endpoint endpoint, icd::BearerToken token)
    : impl_(std::make_shared<Impl>(loop, std::move(endpoint), std::move(token))) {}
Connection::~Connection() {
  impl_->abandon();
}

void Connection::keep_warm() {
  impl_->keep_warm();
}
void Connection::hurry() {
  impl_->hurry();
}
void Connection::send(Request request, std::function<void(Outcome)> done) {
  impl_->send(std::move(request), std::move(done));
}
bool Connection::busy() const {
  return impl_->busy();
}
bool Connection::connected() const {
  return impl_->connected();
}
const std::string& Connection::trouble() const {
  return impl_->trouble();
}
std::size_t Connection::sent_bytes() const {
  return impl_->sent_bytes();
}
}  // namespace adit::uplink
