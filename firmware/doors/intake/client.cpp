#include "intake/client.hpp"

#include <linux/tcp.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <utility>

#include "icd/text.hpp"
#include "intake/answer.hpp"
#include "intake/request.hpp"

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

void Deadline::on_client_end() {
  if (!std::exchange(ended_, true) && bytes_expected_) expect_bytes(kAfterEnd);
}

bool Deadline::is_late() {
  if (bytes_expected_ && ended_ && gate_.unread() > 0) {
    expect_bytes(kAfterEnd);
    return false;
  }
  if (is_fast_enough()) return false;
  expect_nothing();
  return true;
}

bool Deadline::is_fast_enough() {
  if (!rate_) return false;
  if (!bytes_expected_) {
    const std::uint64_t before = std::exchange(taken_before_, gate_.traffic().taken);
    rate_->count_bytes(taken_before_ - before);
  }
  if (rate_->is_too_slow(engine_.now())) return false;
  set(rate_->next_check());
  return true;
}

void Deadline::expect_rate() {
  rate_.emplace(engine_.listen().rate_over, engine_.now());
  set(rate_->next_check());
}

void Deadline::set(loop::Instant when) {
  at_ = when;
  engine_.schedule_check(at_);
}

namespace {

/// Reads of a chunked body per turn of the loop, and the bytes of each.
constexpr int kPiecesAtOnce = 4;
constexpr std::size_t kPieceBytes = 16 * 1024;

/// Unique in the process, because a process may have several servers, and tests have several loops.
std::uint64_t next_number() {
  static std::atomic<std::uint64_t> last = 0;
  return ++last;
}

/// The events that epoll would report, so that a client that hung up while it was added holds no place.
std::uint32_t state_of(int fd) {
  pollfd asked{.fd = fd, .events = POLLIN | POLLRDHUP, .revents = 0};
  static_assert(POLLIN == EPOLLIN && POLLHUP == EPOLLHUP && POLLERR == EPOLLERR && POLLRDHUP == EPOLLRDHUP);
  return ::poll(&asked, 1, 0) == 1 ? static_cast<std::uint32_t>(asked.revents) : 0;
}

}  // namespace

Client::Client(Engine& engine, loop::Loop& loop, MHD_Connection* connection, int fd, Addresses addresses)
    : engine_(engine),
      connection_(connection),
      fd_(fd),
      number_(next_number()),
      addresses_(std::move(addresses)),
      gate_(fd, addresses_.proxy_header),
      deadline_(engine, gate_),
      look_again_(loop.timer([this] { check_head(); })) {
  // libmicrohttpd does not watch the sockets of suspended connections, and misses an end that arrives
  // together with the last bytes. Edge-triggered, because unread bytes would be reported again and again.
  arrivals_ =
      loop.watch(fd, EPOLLIN | EPOLLRDHUP | EPOLLET, [this](std::uint32_t events) { on_events(events); });
  await_head();
}

std::optional<ConnectionInfo> Client::held_share() const {
  if (leaving_ || hung_up_) return std::nullopt;
  return ConnectionInfo{.number = number_,
                        .address = addresses_.peer,
                        .known = deadline_.is_authenticated(),
                        .doing = activity(),
                        .since = stage_.since};
}

ConnectionInfo::Activity Client::activity() const {
  if (stage_.phase == Phase::Idle) return ConnectionInfo::Activity::Idle;
  if (stage_.phase == Phase::Head && gate_.has_unseen()) return ConnectionInfo::Activity::Fresh;
  if (stage_.phase == Phase::Head || request_->is_sending()) return ConnectionInfo::Activity::Sending;
  return deadline_.has_client_ended() && suspended_ ? ConnectionInfo::Activity::Left
                                                    : ConnectionInfo::Activity::Waiting;
}

void Client::give_way() {
  engine_.on_closed(stage_.phase == Phase::Idle ? CloseReason::Idle : CloseReason::GaveWay, addresses_.peer);
  if (stage_.phase == Phase::Head || (stage_.phase == Phase::Request && request_->is_unanswered())) {
    write_last(last_answer_text(
        error_answer(icd::Status::ServiceUnavailable,
                     "too many connections are open; this connection was closed for another; try again"),
        true));
  }
  cut();
}

void Client::on_events(std::uint32_t events) {
  if ((events & EPOLLIN) != 0) gate_.on_bytes();
  if ((events & (EPOLLHUP | EPOLLERR)) != 0) {
    hung_up_ = true;
    if (reads_ && suspended_) return cut();
    if (reads_) return resume_reading();
    resume();
    return;
  }
  if ((events & EPOLLRDHUP) != 0) deadline_.on_client_end();
  if (reads_) return resume_reading();
  check_head();
}

void Client::pause_reading() {
  if (reads_) return resume_reading();
  if (hung_up_ || leaving_) return;
  suspend();
  if (stage_.phase == Phase::Head) {
    on_events(state_of(fd_));
  } else if (gate_.has_new_bytes() || deadline_.has_client_ended()) {  // on_events() will tell later bytes
    check_head();
  }
}

void Client::check_head() {
  const bool has_ended = deadline_.has_client_ended();
  if (gate_.has_refused() && (!gate_.discard_received() || has_ended)) cut();
  if (!gate_.is_waiting() || !suspended_) return;
  switch (gate_.check_bytes(engine_.now(), has_ended)) {
    case Gate::Finding::Whole:
      reads_ = gate_.next_is_chunked();
      resume();
      return;
    case Gate::Finding::Refused:
      refuse_head();
      return;
    case Gate::Finding::Later:
      look_again_.call_at(gate_.next_check());
      break;
    case Gate::Finding::Begun:
      if (stage_.phase != Phase::Idle) break;
      await_head();
      break;
    case Gate::Finding::Nothing:
      break;
  }
  if (has_ended) cut();
}

void Client::refuse_head() {
  const HeadChecker& head = gate_.head();
  Answer answer = error_answer(head.refusal().status, head.refusal().sentence);
  if (head.names_icd_uri()) allow_any_origin(answer);
  write_last(last_answer_text(answer, !head.is_head_method()));
  enter(Phase::Head);
  deadline_.expect_last_reading();
  check_head();
}

bool Client::begin_chunked() {
  if (!gate_.consume_head()) return false;
  const auto begin = [this] {
    engine_.begin_request(*this);
    return ConnectionAction::KeepOpen;
  };
  return run_guarded(begin) == ConnectionAction::KeepOpen;
}

/// libmicrohttpd does not take part: version 0.9 accepts chunks that RFC 9112 does not allow, and version 1
/// misreads extensions and refuses without a sentence.
void Client::resume_reading() {
  if (stage_.phase != Phase::Request && !begin_chunked()) return cut();
  std::array<std::uint8_t, kPieceBytes> bytes;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  for (int left = kPiecesAtOnce; reads_ && !suspended_; --left) {
    if (left == 0) {
      engine_.schedule_hold_back(number_);
      engine_.schedule_run();
      return;
    }
    ConnectionAction next = ConnectionAction::Close;
    if (request_->has_unended_body()) {
      next = run_guarded([this] { return request_->end(); });
    } else {
      const ssize_t size = ::recv(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (size < 0 && errno == EAGAIN) return;
      if (size > 0) {
        next = run_guarded([&] { return request_->body({bytes.data(), static_cast<std::size_t>(size)}); });
      }
    }
    if (next == ConnectionAction::Close) cut();
  }
}

ConnectionAction Client::fail() {
  ConnectionAction next = ConnectionAction::Close;
  if (request_) loop::run_guarded("the answer to a failed request", [&] { next = request_->on_failed(); });
  return next;
}

void Client::request_begun(std::shared_ptr<Request> request) {
  request_ = std::move(request);
  enter(Phase::Request);
  deadline_.expect_nothing();
}

void Client::on_request_end(bool is_answered) {
  const bool stays = is_answered && request_->keeps_connection() && client_keeps_connection();
  request_ = nullptr;
  enter(Phase::Idle);
  deadline_.expect_bytes(engine_.listen().idle);
  gate_.on_request_end();
  if (!gate_.is_waiting()) return;
  if (stays) {
    pause_reading();  // now, because later libmicrohttpd has added the socket to its epoll set
  } else {
    engine_.schedule_hold_back(number_);  // libmicrohttpd is perhaps about to close it
  }
}

bool Client::client_keeps_connection() const {
  const std::string_view said = request_->head().header("Connection");
  return !gate_.framing().is_version_1_0 && (said.empty() || icd::equals_ignoring_case(said, "keep-alive"));
}

void Client::await_head() {
  enter(Phase::Head);
  deadline_.expect_head();
}

void Client::expect_stream() {
  constexpr int kUnsent = 16 * 1024, kUntaken = static_cast<int>(kStreamWithin.count());
  deadline_.expect_nothing();
  ::setsockopt(fd_, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kUnsent, sizeof kUnsent);
  ::setsockopt(fd_, IPPROTO_TCP, TCP_USER_TIMEOUT, &kUntaken, sizeof kUntaken);
}

void Client::on_late() {
  if (!deadline_.is_late()) return;
  if (gate_.has_refused()) return cut();
  switch (stage_.phase) {
    case Phase::Request:
      request_->on_late();
      return;
    case Phase::Idle:
      cut();
      return;
    case Phase::Head:
      engine_.on_closed(CloseReason::Slow, addresses_.peer);
      write_last(last_answer_text(
          error_answer(icd::Status::RequestTimeout, "the head of the request took too long"), true));
      cut();
      return;
  }
}

void Client::suspend() {
  if (std::exchange(suspended_, true) || reads_) return;
  MHD_suspend_connection(connection_);
}

void Client::resume() {
  if (!std::exchange(suspended_, false)) return;
  if (reads_) {
    engine_.schedule_hold_back(number_);
  } else {
    MHD_resume_connection(connection_);
  }
  engine_.schedule_run();
}

void Client::write_text(std::string_view text) {
  // A few hundred bytes into an empty send buffer. A client that does not read loses the rest.
  ::send(fd_, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

void Client::write_last(std::string_view text) {
  if (stage_.phase != Phase::Request) gate_.discard_received();
  write_text(text);
  ::shutdown(fd_, SHUT_WR);
}

void Client::cut() {
  leaving_ = true;
  ::shutdown(fd_, SHUT_RDWR);
  if (std::exchange(reads_, false)) suspended_ = true;
  resume();
  engine_.schedule_run();
}

}  // namespace adit::intake
