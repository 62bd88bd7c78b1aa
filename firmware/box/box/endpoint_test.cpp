#include "box/endpoint_test.hpp"

#include <sys/epoll.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "codec/read.hpp"
#include "codec/write.hpp"
#include "dispatch/mapping_verdict.hpp"
#include "forward/channel.hpp"
#include "uplink/socket.hpp"

namespace adit::box {
namespace {

constexpr int kTooMany = 429;

/// From an answer to GET /api/status.
std::optional<double> run_clock_in(const uplink::Answered& answer) {
  if (answer.status != 200) return std::nullopt;
  const auto status = codec::read_run_status(answer.body);
  return status ? std::optional(status->run_clock) : std::nullopt;
}

/// In place of the status.
bool is_page(const uplink::Answered& answer) {
  return answer.status == 200 && dispatch::body_of(answer.body) == dispatch::Body::Other;
}

icd::ChunkedBytes empty_object() {
  static constexpr std::uint8_t kBytes[] = {'{', '}'};
  return icd::ChunkedBytes(kBytes);
}

}  // namespace

EndpointTest::EndpointTest(loop::Loop& loop, const Turns& turns, const settings::CommandPost& in_use,
                           const TestTarget& tried, steps::Asked asked,
                           std::function<void(api::TestStep)> done)
    : loop_(loop),
      turns_(turns),
      in_use_(in_use),
      tried_(tried),
      asked_(asked),
      done_(std::move(done)),
      timer_(loop.timer([this] { std::exchange(when_due_, {})(); })) {}

uplink::Endpoint EndpointTest::there() const {
  auto endpoint = forward::endpoint_of(tried_.post, address(), 0);
  endpoint.connect_within = kReachWithin;
  return endpoint;
}

void EndpointTest::reach() {
  auto socket = uplink::begin_connect(there());
  if (!socket) return connected(socket.error().error, socket.error().why);
  socket_ = std::move(*socket);
  connecting_ = loop_.watch(socket_.get(), EPOLLOUT, [this](std::uint32_t) {
    const int error = uplink::connect_error(socket_.get());
    connected(error, error == 0 ? "" : std::strerror(error));
  });
  when_due_ = [this] { connected(ETIMEDOUT, std::strerror(ETIMEDOUT)); };
  timer_.call_at(loop_.now() + kReachWithin);
}

void EndpointTest::connected(int error, const std::string& why) {
  timer_.cancel();
  connecting_ = {};
  socket_ = loop::FileDescriptor();
  done_(steps::reach(forward::address_text(address()), error, why));
}

/// At an endpoint of the run this takes one of the run's turns, so that the run is not throttled.
void EndpointTest::ask(const char* step, std::function<void(uplink::Outcome)> done) {
  if (!is_of_the_run()) return send(std::move(done));
  const auto at = turns_.claim(uri(), loop_.now() + kLongestTurn);
  if (!at) return done_(steps::no_turn(step));
  when_due_ = [this, done = std::move(done)] {
    turns_.claimed(uri());  // at the time of sending, which may be later
    send([this, done](uplink::Outcome outcome) {
      turns_.claimed(uri());
      done(std::move(outcome));
    });
  };
  timer_.call_at(*at);
}

void EndpointTest::send(std::function<void(uplink::Outcome)> done) {
  const bool scoring = asked_ == steps::Asked::Scoring;
  connection_ = std::make_unique<uplink::Connection>(loop_, there(), *token());
  connection_->send({.method = std::string(icd::method_of(uri())),
                     .target = std::string(icd::path_of(uri())) + (wants_slash_ ? "/" : ""),
                     .content_type = scoring ? "" : std::string(codec::kJson),
                     .body = scoring ? icd::ChunkedBytes() : empty_object(),
                     .answer_within = kAnswerWithin},
                    [this, done = std::move(done)](uplink::Outcome outcome) {
                      connection_->close();  // the server may serve one connection at a time
                      done(std::move(outcome));
                    });
}

void EndpointTest::check_token() {
  if (!token()) return done_(steps::no_token(asked_));
  ask("token", [this](const uplink::Outcome& outcome) { token_answered(outcome); });
}

/// Repeats once after a 429, because Adit requests the status too. Follows a redirect to a slash, and tries a
/// slash if the status is a web page, as forward::Channel does.
void EndpointTest::token_answered(const uplink::Outcome& outcome) {
  const auto* answer = std::get_if<uplink::Answered>(&outcome);
  if (answer != nullptr) {
    clocks_ = {.date = answer->date, .run_clock = run_clock_in(*answer), .answered_at = loop_.wall_now()};
  }
  const bool is_status = answer != nullptr && codec::read_run_status(answer->body).has_value();
  if (page_ && !is_status) return done_(steps::token(asked_, *page_, false));
  if (asked_ == steps::Asked::Scoring && answer != nullptr && is_page(*answer) && !wants_slash_)
    page_ = *answer;
  const bool is_redirected = answer != nullptr && (answer->wants_slash == true || (page_ && !wants_slash_));
  if (is_redirected) wants_slash_ = true;
  const bool is_throttled =
      answer != nullptr && answer->status == kTooMany && !std::exchange(asked_again_, true);
  if (!is_redirected && !is_throttled) return done_(steps::token(asked_, outcome, wants_slash_));
  when_due_ = [this] { check_token(); };
  timer_.call_at(loop_.now() + kAskAgain);
}

void EndpointTest::check_clock() {
  if (clocks_.date || asked_ == steps::Asked::Mapping || !token() || !clocks_.run_clock)
    return done_(steps::clock(clocks_.date, clocks_.answered_at));
  when_due_ = [this] {
    ask("clock", [this](const uplink::Outcome& outcome) {
      const auto* answer = std::get_if<uplink::Answered>(&outcome);
      done_(steps::run_clock(clocks_.run_clock, answer != nullptr ? run_clock_in(*answer) : std::nullopt));
    });
  };
  timer_.call_at(loop_.now() + kAskAgain);
}

}  // namespace adit::box
