#include "box/self_test.hpp"

#include <utility>

#include "forward/channel.hpp"
#include "host/interfaces.hpp"
#include "icd/try.hpp"

namespace adit::box {
namespace {

constexpr const char* kSteps[] = {"link", "address", "cables", "reach", "token", "clock"};

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
      timer_(loop.timer([this] { probing_.until ? wait_for_probe() : next(); })) {}

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
  probing_ = {};
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
      return reach();
    case At::Token:
      return at_endpoint_->check_token();
    case At::Clock:
      return at_endpoint_->check_clock();
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
  timer_.call_at(loop_.now());
}

void SelfTest::skip_the_rest(const std::string& why) {
  for (api::TestStep& step : endpoint().steps) {
    if (step.state == "waiting") step = steps::skipped(step.name, why);
  }
  at_ = At::End;
  timer_.call_at(loop_.now());
}

void SelfTest::next() {
  if (at_ == At::End) {
    at_endpoint_.reset();
    if (++tested_ == asked_.size()) {
      tried_ = {};
      view_.running = false;
      return changed_();
    }
    at_ = At::Link;
  }
  run_step();
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
  const auto next_hop = network_.next_hop(steps::address_in(tried_.post, kind()));
  if (!next_hop && why.empty()) why = next_hop.error();
  if (own && *own && why.empty()) {
    probing_ = {.probe = {host::draw_nonce(), *next_hop}, .until = loop_.now() + kProbeWithin, .found = {}};
    const auto asked = adit_network_.leave(network::kProbeFile, probing_.probe);
    if (asked) return wait_for_probe();
    why = asked.error();
    probing_ = {};
  }
  finish(steps::address(interface, own, std::nullopt, why));
}

void SelfTest::wait_for_probe() {
  const auto read = host::read_row<network::Probed>(adit_network_.directory() + '/' + network::kProbedFile);
  probing_.found = read.value_or(std::nullopt);
  if (probing_.found && probing_.found->nonce != probing_.probe.nonce) probing_.found.reset();
  if (!probing_.found && loop_.now() < *probing_.until) return timer_.call_at(loop_.now() + kProbePoll);
  probing_.until.reset();
  const std::string& interface = tried_.post.interface;
  finish(steps::address(interface, host::own_address(interface), probing_.found,
                        read ? "adit-network did not answer" : read.error()));
}

void SelfTest::look_at_cables() {
  finish(
      steps::cables(tried_.post.interface, settings_.team.interface, probing_.probe.sought, probing_.found));
}

void SelfTest::reach() {
  at_endpoint_.emplace(loop_, turns_, settings_.command_post, tried_, kind(),
                       [this](api::TestStep step) { finish(std::move(step)); });
  at_endpoint_->reach();
}

}  // namespace adit::box
