#include "box/self_test.hpp"

#include <sys/epoll.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "codec/read.hpp"
#include "codec/write.hpp"
#include "forward/channel.hpp"
#include "host/interfaces.hpp"
#include "host/service.hpp"
#include "icd/try.hpp"
#include "icd/uri.hpp"
#include "uplink/socket.hpp"

namespace adit::box {
namespace {

constexpr const char* kSteps[] = {"link", "address", "cables", "reach", "token", "clock"};
constexpr int kTooMany = 429;

/// From an answer to GET /api/status.
std::optional<double> run_clock_in(const uplink::Answered& answer) {
  if (answer.status != 200) return std::nullopt;
  const auto status = codec::read_run_status(answer.body);
  return status ? std::optional(status->run_clock) : std::nullopt;
}

icd::ChunkedBytes empty_object() {
  static constexpr std::uint8_t kBytes[] = {'{', '}'};
  return icd::ChunkedBytes(kBytes);
}

}  // namespace

SelfTest::SelfTest(loop::Loop& loop, const settings::Settings& settings,
                   std::function<icd::Checked<TestTarget>(const api::Candidate&)> tried, Turns turns,
                   host::RootProgram<network::Status>& adit_network, const admin::NetworkChange& network,
                   std::function<void()> changed)
    : loop_(loop),
      settings_(settings),
      tried_of_(std::move(tried)),
      turns_(std::move(turns)),
      adit_network_(adit_network),
      network_(network),
      changed_(std::move(changed)),
      timer_(loop.timer([this] { std::exchange(when_due_, {})(); })) {}

icd::Checked<void> SelfTest::begin_test(const api::Candidate& candidate) {
  if (view_.running)
    return std::unexpected(icd::Refusal{icd::Status::Conflict, "a test is running: see GET /adit/test"});
  auto tried = ADIT_TRY(tried_of_(candidate));
  tried_ = std::move(tried);
  view_ = {.number = view_.number + 1,
           .running = true,
           .applied = candidate.is_applied(),
           .course = tried_.post.course,
           .endpoints = {}};
  asked_.clear();
  const bool all = !candidate.scoring && !candidate.mapping;
  if (all || candidate.scoring) list(steps::Asked::Scoring);
  if (all || candidate.mapping) list(steps::Asked::Mapping);
  tested_ = 0;
  probed_.reset();
  at_ = At::Link;
  run_step();
  return {};
}

void SelfTest::list(steps::Asked asked) {
  asked_.push_back(asked);
  api::TestedEndpoint endpoint{.name = steps::name_of(asked),
                               .address = forward::address_text(steps::address_in(tried_.post, asked)),
                               .steps = {}};
  for (const char* step : kSteps) endpoint.steps.push_back({.name = step, .said = "", .advice = ""});
  view_.endpoints.push_back(std::move(endpoint));
}

void SelfTest::run_step() {
  endpoint().steps[static_cast<std::size_t>(at_)].state = "running";
  changed_();
  const std::string& interface = tried_.post.interface;
  switch (at_) {
    case At::Link:
      return finish(steps::link(interface, host::carrier(interface)));
    case At::Address:
      return ask_address();
    case At::Cables:
      return look_at_cables();
    case At::Reach:
      return connect();
    case At::Token:
      return ask_token();
    case At::Clock:
      return ask_clock();
    case At::End:
      return;
  }
}

/// The next step runs in a later turn of the loop.
void SelfTest::finish(api::TestStep step) {
  const bool is_bad = step.state == "bad";
  tried_.typed.strike_from(step.said);  // an answer may echo tokens
  const std::string said = step.said;
  endpoint().steps[static_cast<std::size_t>(at_)] = std::move(step);
  if (is_bad && at_ != At::Address && at_ != At::Cables && at_ != At::Token)
    return skip_the_rest("not tried: " + said);
  at_ = static_cast<At>(static_cast<int>(at_) + 1);
  next();
}

void SelfTest::skip_the_rest(const std::string& why) {
  for (api::TestStep& step : endpoint().steps) {
    if (step.state == "waiting") step = steps::skipped(step.name, why);
  }
  at_ = At::End;
  next();
}

void SelfTest::next() {
  if (at_ == At::End) {
    connection_.reset();
    if (++tested_ == asked_.size()) return over();
    at_ = At::Link;
  }
  when_due_ = [this] { run_step(); };
  timer_.call_at(loop_.now());
}

void SelfTest::over() {
  tried_ = {};
  view_.running = false;
  changed_();
}

/// Once for both endpoints, which share the interface.
void SelfTest::ask_address() {
  if (tested_ > 0 && view_.endpoints.front().steps[1].state != "skipped")
    return finish(view_.endpoints.front().steps[1]);
  const std::string& interface = tried_.post.interface;
  const auto own = host::own_address(interface);
  const auto status = adit_network_.status();
  std::string why;
  if (!status) {
    why = adit_network_.why();
  } else if (status->command_post_interface != interface) {
    why = "adit-network has " + status->command_post_interface + " instead";
  }
  const auto next_hop = network_.next_hop(address());
  if (!next_hop && why.empty()) why = next_hop.error();
  if (own && *own && why.empty()) {
    probe_ = {host::draw_nonce(), *next_hop};
    const auto asked = adit_network_.leave(network::kProbeFile, probe_);
    until_ = loop_.now() + kProbeWithin;
    if (asked) return wait_for_probe();
    why = asked.error();
  }
  finish(steps::address(interface, own, std::nullopt, why));
}

void SelfTest::wait_for_probe() {
  const auto read = host::read_row<network::Probed>(adit_network_.directory() + '/' + network::kProbedFile);
  auto probed = read.value_or(std::nullopt);
  if (probed && probed->nonce != probe_.nonce) probed.reset();
  if (!probed && loop_.now() < until_) {
    when_due_ = [this] { wait_for_probe(); };
    return timer_.call_at(loop_.now() + kProbePoll);
  }
  const std::string& interface = tried_.post.interface;
  probed_ = probed;
  finish(steps::address(interface, host::own_address(interface), probed,
                        read ? "adit-network did not answer" : read.error()));
}

void SelfTest::look_at_cables() {
  finish(steps::cables(tried_.post.interface, settings_.team.interface, probe_.sought, probed_));
}

uplink::Endpoint SelfTest::there() const {
  auto endpoint = forward::endpoint_of(tried_.post, address(), 0);
  endpoint.connect_within = kReachWithin;
  return endpoint;
}

void SelfTest::connect() {
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

void SelfTest::connected(int error, const std::string& why) {
  timer_.cancel();
  connecting_ = {};
  socket_ = loop::FileDescriptor();
  finish(steps::reach(endpoint().address, error, why));
}

/// At an endpoint of the run this takes one of the run's turns, so that the run is not throttled.
void SelfTest::ask(std::function<void(uplink::Outcome)> done) {
  if (!is_of_the_run()) return send(std::move(done));
  const auto at = turns_.claim(uri(), loop_.now() + kLongestTurn);
  if (!at) return finish(steps::no_turn(kSteps[static_cast<std::size_t>(at_)]));
  when_due_ = [this, done = std::move(done)] {
    turns_.claimed(uri());  // at the time of sending, which may be later
    send([this, uri = uri(), done](uplink::Outcome outcome) {
      turns_.claimed(uri);
      done(std::move(outcome));
    });
  };
  timer_.call_at(*at);
}

void SelfTest::send(std::function<void(uplink::Outcome)> done) {
  const bool scoring = kind() == steps::Asked::Scoring;
  connection_ = std::make_unique<uplink::Connection>(loop_, there(), *token());
  connection_->send({.method = std::string(icd::method_of(uri())),
                     .target = std::string(icd::path_of(uri())) + (wants_slash_ ? "/" : ""),
                     .content_type = scoring ? "" : std::string(codec::kJson),
                     .body = scoring ? icd::ChunkedBytes() : empty_object(),
                     .answer_within = kAnswerWithin},
                    std::move(done));
}

void SelfTest::ask_token() {
  date_.reset();
  run_clock_.reset();
  asked_again_ = wants_slash_ = false;
  if (!token()) return finish(steps::no_token(kind()));
  ask([this](const uplink::Outcome& outcome) { token_answered(outcome); });
}

/// Repeats once after a 429, because Adit requests the status too. Follows a redirect to a slash.
void SelfTest::token_answered(const uplink::Outcome& outcome) {
  const auto* answer = std::get_if<uplink::Answered>(&outcome);
  answered_at_ = loop_.wall_now();
  if (answer != nullptr) {
    date_ = answer->date;
    run_clock_ = run_clock_in(*answer);
  }
  const bool is_redirected = answer != nullptr && answer->wants_slash;
  if (is_redirected) wants_slash_ = true;
  const bool is_throttled =
      answer != nullptr && answer->status == kTooMany && !std::exchange(asked_again_, true);
  if (is_redirected || is_throttled) {
    when_due_ = [this] { ask([this](const uplink::Outcome& again) { token_answered(again); }); };
    return timer_.call_at(loop_.now() + kAskAgain);
  }
  finish(steps::token(kind(), outcome, wants_slash_));
}

void SelfTest::ask_clock() {
  if (date_ || kind() == steps::Asked::Mapping || !token() || !run_clock_) {
    return finish(steps::clock(date_, answered_at_));
  }
  when_due_ = [this] { ask_again(); };
  timer_.call_at(loop_.now() + kAskAgain);
}

void SelfTest::ask_again() {
  ask([this](const uplink::Outcome& outcome) {
    const auto* answer = std::get_if<uplink::Answered>(&outcome);
    finish(steps::run_clock(run_clock_, answer != nullptr ? run_clock_in(*answer) : std::nullopt));
  });
}

}  // namespace adit::box
