#include "box/self_test.hpp"

#include <sys/epoll.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

#include "admin/setup.hpp"
#include "codec/read.hpp"
#include "codec/write.hpp"
#include "dispatch/verdicts.hpp"
#include "forward/channel.hpp"
#include "host/interfaces.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "settings/written.hpp"
#include "uplink/socket.hpp"

namespace adit::box {
namespace {

using Endpoint = std::optional<api::Candidate::Endpoint>;

void put(const Endpoint& typed, settings::Address& address) {
  if (!typed) return;
  address.address = typed->address.value_or(address.address);
  address.port = typed->port.value_or(address.port);
}

/// Names errors by the candidate's members.
icd::Refusal settings_refusal(std::vector<settings::Error> errors) {
  constexpr std::string_view kOwn = "command_post.";
  for (settings::Error& error : errors) {
    if (error.path.starts_with(kOwn)) error.path.erase(0, kOwn.size());
  }
  return {icd::Status::UnprocessableEntity, settings::sentence_of(errors)};
}

std::optional<icd::BearerToken> token_of(const char* name, const Endpoint& typed,
                                         const settings::Settings& settings, const host::Secrets& secrets,
                                         icd::Redaction& redaction) {
  if (!typed || !typed->token) return admin::token_for(name, settings, secrets);
  redaction.add(*typed->token);
  return typed->token;
}

}  // namespace

icd::Checked<TestTarget> tried_of(const api::Candidate& candidate, const settings::Settings& written,
                                  const host::Secrets& secrets) {
  settings::Settings next = written;
  if (candidate.course) next.command_post.course = *candidate.course;
  const auto known = settings::parse(settings::value_of(next));  // checks the course
  if (!known) return std::unexpected(settings_refusal(known.error()));
  const settings::Settings in_use = settings::effective_settings(*known);
  // Clears the course, which would replace these addresses.
  next.command_post = in_use.command_post;
  put(candidate.scoring, next.command_post.scoring);
  put(candidate.mapping, next.command_post.mapping);
  const auto checked = settings::parse(settings::value_of(next));
  if (!checked) return std::unexpected(settings_refusal(checked.error()));
  TestTarget tried{.post = checked->command_post, .scoring = {}, .mapping = {}};
  tried.scoring = token_of("scoring", candidate.scoring, in_use, secrets, tried.typed);
  tried.mapping = token_of("mapping", candidate.mapping, in_use, secrets, tried.typed);
  return tried;
}

namespace steps {
namespace {

TestStep good(std::string name, std::string said) {
  return {.name = std::move(name), .state = "good", .said = std::move(said), .advice = ""};
}
TestStep bad(std::string name, std::string said, std::string advice) {
  return {.name = std::move(name), .state = "bad", .said = std::move(said), .advice = std::move(advice)};
}

std::string check_answer(int status, const std::string& body) {
  const std::string answer = icd::sentence("the answer is ", status);
  switch (dispatch::body_of(body)) {
    case dispatch::Body::Empty:
      return answer + " without a body";
    case dispatch::Body::Other:
      return answer + " with a body that is not JSON";
    case dispatch::Body::Json:
      break;
  }
  return icd::sentence(answer, ": ", dispatch::answer_text(status, body));
}

/// An error about the empty request shows that the token passed.
bool is_token_accepted(EndpointKind asked, int status, dispatch::Body body) {
  if (body == dispatch::Body::Other) return false;  // not a Command Post's answer
  if (status >= 200 && status < 300) return true;
  return asked == EndpointKind::Mapping && (status == 400 || status == 415 || status == 422);
}

std::string no_endpoint(EndpointKind asked) {
  return icd::sentence("This is no ", name_of(asked), " endpoint: compare the ", name_of(asked),
                       " address and port with those posted in the Base Station area; scoring and mapping "
                       "may be exchanged.");
}

}  // namespace

const char* name_of(EndpointKind asked) {
  return asked == EndpointKind::Scoring ? "scoring" : "mapping";
}

const settings::Address& address_in(const settings::CommandPost& post, EndpointKind asked) {
  return asked == EndpointKind::Scoring ? post.scoring : post.mapping;
}

TestStep skipped_step(const std::string& name, const std::string& why) {
  return {.name = name, .state = "skipped", .said = why, .advice = ""};
}

TestStep link(const std::string& interface, std::optional<bool> carrier) {
  if (interface.empty())
    return skipped_step("link", "the settings name no command_post.interface: any interface is used");
  if (!carrier) {
    return bad(
        "link", icd::sentence("there is no interface ", interface),
        "Check command_post.interface in the settings; `ip link` on the box's console lists the interfaces.");
  }
  if (*carrier) return good("link", icd::sentence(interface, " has a carrier"));
  return bad(
      "link", icd::sentence(interface, " has no carrier"),
      "Plug the Command Post's cable into the box, check the lights of both plugs, and try another cable.");
}

TestStep address(const std::string& interface,
                 const std::expected<std::optional<settings::Subnet>, std::string>& own,
                 const std::optional<network::ProbeResult>& probed, const std::string& not_asked) {
  if (interface.empty()) return skipped_step("address", "the settings name no command_post.interface");
  if (!own) return skipped_step("address", own.error());
  if (!*own) {
    return bad(
        "address", icd::sentence(interface, " has no IPv4 address"),
        "Set an address in the Command Post's subnet, on the page or in the box's network configuration.");
  }
  const std::string conflict = probed && !probed->claimant.empty() ? probed->address : "";
  const std::string has =
      icd::sentence(interface, " has ", conflict.empty() ? network::host_text(**own) : conflict);
  if (!probed)
    return skipped_step("address", icd::sentence(has, "; not checked for an address conflict: ", not_asked));
  if (!probed->trouble.empty()) {
    return skipped_step("address",
                        icd::sentence(has, "; could not check for an address conflict: ", probed->trouble));
  }
  if (!probed->own.empty()) {
    return bad("address",
               icd::sentence(has, ", but the box's own ", probed->own, " also answers for this address"),
               "Both cables of the box are in one network: plug each into its own network.");
  }
  if (!probed->claimant.empty()) {
    return bad(
        "address", icd::sentence(has, ", but the machine ", probed->claimant, " has the same address"),
        "Give the box another address on the Command Post's side, or ask the organiser which machine has "
        "this address.");
  }
  return good("address", icd::sentence(has, ", without an address conflict"));
}

TestStep cables(const std::string& interface, const std::string& team, const std::string& sought,
                const std::optional<network::ProbeResult>& probed) {
  if (!probed || sought.empty())
    return skipped_step("cables", "could not check which network is at which port");
  if (probed->found_on == interface) return good("cables", icd::sentence(sought, " is at ", interface));
  if (probed->found_on.empty() && !probed->not_sought.empty())
    return skipped_step(
        "cables", icd::sentence("could not check which network is at which port: ", probed->not_sought));
  if (probed->found_on.empty() || probed->found_on != team) {
    return skipped_step("cables", icd::sentence("no machine answers for ", sought, " at either port"));
  }
  return bad("cables", icd::sentence(sought, " is not at ", interface, " but at ", team),
             "The Command Post's network is at the team's port: exchange the two cables.");
}

TestStep reach(const std::string& at, int error, const std::string& why) {
  switch (error) {
    case 0:
      if (why.empty()) return good("reach", icd::sentence(at, " accepts a connection"));
      return bad("reach", icd::sentence(at, ": ", why), "Check the endpoint's address.");
    case ECONNREFUSED:
      return bad(
          "reach",
          icd::sentence(at,
                        " refuses the connection: the machine is running, but has no server at that port"),
          "Compare the port with the one posted in the Base Station area, or ask whether the server runs.");
    case ENETUNREACH:
      return bad("reach", icd::sentence("there is no route to ", at),
                 "Compare the box's address and prefix on that side with the endpoint's. If they are in "
                 "different subnets, a gateway is missing.");
    case EHOSTUNREACH:
      return bad("reach", icd::sentence("no machine answers for ", at),
                 "Compare the address with the one posted in the Base Station area, and check where the "
                 "cable leads.");
    case ETIMEDOUT:
      return bad("reach", icd::sentence(at, " does not answer"),
                 "Compare the address with the one posted in the Base Station area. If it is correct, a "
                 "firewall or the server itself does not answer.");
    case ENODEV:
      return bad("reach", why, "Check command_post.interface in the settings.");
    default:
      return bad("reach", icd::sentence(at, ": ", why), "Check the endpoint's address.");
  }
}

TestStep no_token(EndpointKind asked) {
  return bad("token", icd::sentence("there is no ", name_of(asked), " token"),
             "Enter the token from the organisers.");
}

TestStep no_turn(const std::string& name) {
  return skipped_step(
      name, "not checked: the run itself uses all requests that the endpoint allows; try again later");
}

TestStep token(EndpointKind asked, const uplink::Outcome& outcome, bool slash) {
  const auto* answer = std::get_if<uplink::Answered>(&outcome);
  if (answer == nullptr) {
    const auto* never = std::get_if<uplink::NeverSent>(&outcome);
    return bad(
        "token", never != nullptr ? never->why : std::get<uplink::InDoubt>(outcome).why,
        icd::sentence("The server accepts connections but gave no answer: compare the ", name_of(asked),
                      " port with the one posted, try again, then ask the organiser."));
  }
  const int status = answer->status;
  const dispatch::Body body = dispatch::body_of(answer->body);
  const bool is_taken = is_token_accepted(asked, status, body);
  if (is_taken && asked == EndpointKind::Scoring) {
    if (const auto run = codec::read_run_status(answer->body); !run)
      return bad(
          "token",
          icd::sentence("the answer to GET /api/status is not the status of a run (ICD 5.1): ", run.error()),
          no_endpoint(asked));
  }
  if (is_taken)
    return good("token", icd::sentence("the ", name_of(asked), " token is accepted",
                                       slash ? "; paths end with a slash there" : ""));
  if ((status == 401 || status == 403) && body != dispatch::Body::Other) {
    return bad(
        "token",
        icd::sentence("the ", name_of(asked), " token is rejected; ", check_answer(status, answer->body)),
        icd::sentence("Enter the token again exactly; scoring and mapping may have different tokens. If "
                      "the token is right, compare the ",
                      name_of(asked), " address and port with those posted."));
  }
  if (status == 429)
    return skipped_step("token",
                        "the endpoint got too many requests to check the token: try again in a few seconds");
  if (status >= 500 && status != 501) {
    return skipped_step("token", icd::sentence("the endpoint failed before it checked the token; ",
                                               check_answer(status, answer->body)));
  }
  return bad("token", check_answer(status, answer->body), no_endpoint(asked));
}

TestStep unknown_path(TestStep accepted, int status, const uplink::Outcome& outcome) {
  const auto* answer = std::get_if<uplink::Answered>(&outcome);
  if (answer == nullptr || answer->status == icd::kTooManyRequests) {
    return skipped_step("token",
                        icd::sentence("POST /state/update got ", status, ", but POST ", kUnknownPath,
                                      " got no answer that shows whether this is a mapping endpoint"));
  }
  const bool are_both_good = icd::is_success(status) && icd::is_success(answer->status);
  if (answer->status != status && !are_both_good) return accepted;
  return bad("token",
             icd::sentence("the server accepts any path: it answers POST /state/update with ", status,
                           " and POST ", kUnknownPath, ", which no Command Post has, with ", answer->status),
             no_endpoint(EndpointKind::Mapping));
}

TestStep clock(std::optional<std::chrono::sys_seconds> date, double now) {
  if (!date) return skipped_step("clock", "its answers have no Date");
  // A Date stands for one whole second.
  const double there = static_cast<double>(date->time_since_epoch().count());
  const double ahead = now - std::clamp(now, there, there + 1);
  if (std::abs(ahead) <= static_cast<double>(kOff.count())) {
    return good("clock", "the box's clock agrees with the Command Post's");
  }
  const auto seconds = static_cast<std::int64_t>(std::round(std::abs(ahead)));
  return bad("clock",
             icd::sentence("the box's clock is ", seconds, " s ", ahead > 0 ? "ahead of" : "behind",
                           " the Command Post's"),
             "Set the box's clock: it gives the time stamps of maps and states.");
}

TestStep run_clock(std::optional<double> first, std::optional<double> second) {
  if (!first || !second) return skipped_step("clock", "its answers have no Date and no run clock");
  if (*second > *first) return good("clock", "its answers have no Date, but the run clock moves");
  return skipped_step("clock", icd::sentence("its answers have no Date, and the run clock stands at ",
                                             *second, " s: the run has not started, or has ended"));
}

}  // namespace steps

namespace {

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

EndpointTest::EndpointTest(loop::Loop& loop, const Turns& turns, const TestTarget& tried,
                           steps::EndpointKind asked, std::function<void(api::TestStep)> done)
    : loop_(loop),
      turns_(turns),
      tried_(tried),
      asked_(asked),
      done_(std::move(done)),
      timer_(loop.timer([this] { std::exchange(when_due_, {})(); })) {}

uplink::Endpoint EndpointTest::tested_endpoint() const {
  auto endpoint = forward::endpoint_of(tried_.post, address(), 0);
  endpoint.connect_within = kReachWithin;
  return endpoint;
}

void EndpointTest::reach() {
  auto socket = uplink::begin_connect(tested_endpoint());
  if (!socket) return on_connected(socket.error().error, socket.error().why);
  socket_ = std::move(*socket);
  connecting_ = loop_.watch(socket_.get(), EPOLLOUT, [this](std::uint32_t) {
    const int error = uplink::connect_error(socket_.get());
    on_connected(error, error == 0 ? "" : std::strerror(error));
  });
  when_due_ = [this] { on_connected(ETIMEDOUT, std::strerror(ETIMEDOUT)); };
  timer_.call_at(loop_.now() + kReachWithin);
}

void EndpointTest::on_connected(int error, const std::string& why) {
  timer_.cancel();
  connecting_ = {};
  socket_ = loop::FileDescriptor();
  done_(steps::reach(forward::address_text(address()), error, why));
}

/// At an endpoint of the run this takes one of the run's turns, so that the run is not throttled.
void EndpointTest::ask(const char* step, std::string_view path, std::function<void(uplink::Outcome)> done) {
  if (!turns_.are_shared || !turns_.are_shared(uri(), address())) return send(path, std::move(done));
  const auto at = turns_.claim(uri(), loop_.now() + kLongestTurn);
  if (!at) return done_(steps::no_turn(step));
  when_due_ = [this, path, done = std::move(done)] {
    turns_.on_claimed(uri());  // at the time of sending, which may be later
    send(path, [this, done](uplink::Outcome outcome) {
      turns_.on_claimed(uri());
      done(std::move(outcome));
    });
  };
  timer_.call_at(*at);
}

void EndpointTest::send(std::string_view path, std::function<void(uplink::Outcome)> done) {
  const bool scoring = asked_ == steps::EndpointKind::Scoring;
  connection_ = std::make_unique<uplink::Connection>(loop_, tested_endpoint(), *token());
  connection_->send({.method = std::string(icd::method_of(uri())),
                     .target = std::string(path) + (wants_slash_ ? "/" : ""),
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
  ask("token", icd::path_of(uri()), [this](const uplink::Outcome& outcome) { on_token_answer(outcome); });
}

/// Repeats once after a 429, because Adit requests the status too. Follows a redirect to a slash, and tries a
/// slash if the status is a web page, as forward::Channel does.
void EndpointTest::on_token_answer(const uplink::Outcome& outcome) {
  const auto* answer = std::get_if<uplink::Answered>(&outcome);
  if (answer != nullptr) {
    clocks_ = {.date = answer->date, .run_clock = run_clock_in(*answer), .answered_at = loop_.wall_now()};
  }
  const bool is_status = answer != nullptr && codec::read_run_status(answer->body).has_value();
  if (page_ && !is_status) return done_(steps::token(asked_, *page_, false));
  if (asked_ == steps::EndpointKind::Scoring && answer != nullptr && is_page(*answer) && !wants_slash_)
    page_ = *answer;
  const bool is_redirected = answer != nullptr && (answer->wants_slash == true || (page_ && !wants_slash_));
  if (is_redirected) wants_slash_ = true;
  const bool is_throttled = answer != nullptr && answer->status == 429 && !std::exchange(asked_again_, true);
  if (!is_redirected && !is_throttled) {
    api::TestStep step = steps::token(asked_, outcome, wants_slash_);
    if (step.state == "good" && asked_ == steps::EndpointKind::Mapping)
      return check_unknown_path(std::move(step), answer->status);
    return done_(std::move(step));
  }
  when_due_ = [this] { check_token(); };
  timer_.call_at(loop_.now() + kAskAgain);
}

void EndpointTest::check_unknown_path(api::TestStep accepted, int status) {
  when_due_ = [this, accepted = std::move(accepted), status] {
    ask("token", steps::kUnknownPath, [this, accepted, status](const uplink::Outcome& outcome) {
      done_(steps::unknown_path(accepted, status, outcome));
    });
  };
  timer_.call_at(loop_.now() + kAskAgain);
}

void EndpointTest::check_clock() {
  if (clocks_.date || asked_ == steps::EndpointKind::Mapping || !token() || !clocks_.run_clock)
    return done_(steps::clock(clocks_.date, clocks_.answered_at));
  when_due_ = [this] {
    ask("clock", icd::path_of(uri()), [this](const uplink::Outcome& outcome) {
      const auto* answer = std::get_if<uplink::Answered>(&outcome);
      done_(steps::run_clock(clocks_.run_clock, answer != nullptr ? run_clock_in(*answer) : std::nullopt));
    });
  };
  timer_.call_at(loop_.now() + kAskAgain);
}

namespace {

constexpr const char* kSteps[] = {"link", "address", "cables", "reach", "token", "clock"};

}  // namespace

SelfTest::SelfTest(loop::Loop& loop, const settings::Settings& settings,
                   std::function<icd::Checked<TestTarget>(const api::Candidate&)> tried, Turns turns,
                   const admin::NetworkChange& network, std::function<void()> changed)
    : loop_(loop),
      settings_(settings),
      tried_of_(std::move(tried)),
      turns_(std::move(turns)),
      network_(network),
      changed_(std::move(changed)),
      timer_(loop.timer([this] { probing_.until ? wait_for_probe() : start_next(); })) {}

icd::Checked<void> SelfTest::begin_test(const api::Candidate& candidate) {
  if (view_.running) return icd::conflict("a test is running: see GET /adit/test");
  auto tried = ADIT_TRY(tried_of_(candidate));
  tried_ = std::move(tried);
  view_ = {.number = view_.number + 1,
           .running = true,
           .applied = candidate.is_applied(),
           .course = tried_.post.course,
           .endpoints = {}};
  asked_.clear();
  const bool all = !candidate.scoring && !candidate.mapping;
  if (all || candidate.scoring) list(steps::EndpointKind::Scoring);
  if (all || candidate.mapping) list(steps::EndpointKind::Mapping);
  tested_ = 0;
  probing_ = {};
  at_ = Phase::Link;
  run_step();
  return {};
}

void SelfTest::list(steps::EndpointKind asked) {
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
    case Phase::Link:
      return finish(steps::link(interface, host::carrier(interface)));
    case Phase::Address:
      return ask_address();
    case Phase::Cables:
      return check_cables();
    case Phase::Reach:
      return reach();
    case Phase::Token:
      return at_endpoint_->check_token();
    case Phase::Clock:
      return at_endpoint_->check_clock();
    case Phase::End:
      return;
  }
}

/// The next step runs in a later turn of the loop.
void SelfTest::finish(api::TestStep step) {
  const bool is_bad = step.state == "bad";
  tried_.typed.strike_from(step.said);  // an answer may echo tokens
  const std::string said = step.said;
  endpoint().steps[static_cast<std::size_t>(at_)] = std::move(step);
  if (is_bad && at_ != Phase::Address && at_ != Phase::Cables && at_ != Phase::Token)
    return skip_the_rest("not tried: " + said);
  at_ = static_cast<Phase>(static_cast<int>(at_) + 1);
  timer_.call_at(loop_.now());
}

void SelfTest::skip_the_rest(const std::string& why) {
  for (api::TestStep& step : endpoint().steps) {
    if (step.state == "waiting") step = steps::skipped_step(step.name, why);
  }
  at_ = Phase::End;
  timer_.call_at(loop_.now());
}

void SelfTest::start_next() {
  if (at_ == Phase::End) {
    at_endpoint_.reset();
    if (++tested_ == asked_.size()) {
      tried_ = {};
      view_.running = false;
      return changed_();
    }
    at_ = Phase::Link;
  }
  run_step();
}

/// Once for both endpoints, which share the interface.
void SelfTest::ask_address() {
  if (tested_ > 0 && view_.endpoints.front().steps[1].state != "skipped")
    return finish(view_.endpoints.front().steps[1]);
  const std::string& interface = tried_.post.interface;
  const auto own = host::own_address(interface);
  std::string why;
  if (own && *own) {
    const auto probe = network_.probe(interface, steps::address_in(tried_.post, kind()));
    if (probe) {
      probing_ = {.probe = *probe, .until = loop_.now() + kProbeWithin, .found = {}};
      return wait_for_probe();
    }
    why = probe.error();
  }
  finish(steps::address(interface, own, std::nullopt, why));
}

void SelfTest::wait_for_probe() {
  const auto read = network_.answer_to(probing_.probe);
  probing_.found = read.value_or(std::nullopt);
  if (!probing_.found && loop_.now() < *probing_.until) return timer_.call_at(loop_.now() + kProbePoll);
  probing_.until.reset();
  const std::string& interface = tried_.post.interface;
  finish(steps::address(interface, host::own_address(interface), probing_.found,
                        read ? "adit-network did not answer" : read.error()));
}

void SelfTest::check_cables() {
  finish(
      steps::cables(tried_.post.interface, settings_.team.interface, probing_.probe.sought, probing_.found));
}

void SelfTest::reach() {
  at_endpoint_.emplace(loop_, turns_, tried_, kind(),
                       [this](api::TestStep step) { finish(std::move(step)); });
  at_endpoint_->reach();
}

}  // namespace adit::box
