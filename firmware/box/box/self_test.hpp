#pragma once

#include <chrono>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "admin/network_change.hpp"
#include "api/self_test.hpp"
#include "host/service.hpp"
#include "icd/bearer_token.hpp"
#include "icd/uri.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "network/messages.hpp"
#include "settings/settings.hpp"
#include "uplink/connection.hpp"

namespace adit::box {

/// Endpoints and tokens of a Test.
struct TestTarget {
  settings::CommandPost post;  // addresses to test, and their course
  std::optional<icd::BearerToken> scoring, mapping;
  icd::Redaction typed = icd::Redaction();  // tokens that are not stored
};

/// The settings with the candidate, as if saved. Refused (422) by its members: "scoring.address: ...".
icd::Checked<TestTarget> tried_of(const api::Candidate& candidate, const settings::Settings& written,
                                  const host::Secrets& secrets);

/// Results of the Test's steps: a state, the finding in words, and advice.
namespace steps {

using api::TestStep;

enum class EndpointKind : std::uint8_t { Scoring, Mapping };
const char* name_of(EndpointKind asked);
const settings::Address& address_in(const settings::CommandPost& post, EndpointKind asked);

/// `carrier`: host::carrier(). `interface` "": not set.
TestStep link(const std::string& interface, std::optional<bool> carrier);

/// `own`: host::own_address(); `probed`: adit-network's finding; `not_asked`: why it has none.
TestStep address(const std::string& interface,
                 const std::expected<std::optional<settings::Subnet>, std::string>& own,
                 const std::optional<network::ProbeResult>& probed, const std::string& not_asked);

/// Whether the Command Post is at its own port or at the team's, by the port that finds `sought`, its
/// endpoint or gateway.
TestStep cables(const std::string& interface, const std::string& team, const std::string& sought,
                const std::optional<network::ProbeResult>& probed);

/// `error`: 0 or an errno; `why`: in words.
TestStep reach(const std::string& at, int error, const std::string& why);

/// `slash`: the endpoint redirected to a slash at the end of the path.
TestStep token(EndpointKind asked, const uplink::Outcome& outcome, bool slash = false);
TestStep no_token(EndpointKind asked);

/// A path that no Command Post has.
inline constexpr std::string_view kUnknownPath = "/adit-test";
/// `outcome`: of the mapping endpoint's request to kUnknownPath, after it `accepted` the token with `status`.
/// A Command Post answers 404 (ICD 4.1) or 501. A server that answers both paths alike is none: bad.
TestStep unknown_path(TestStep accepted, int status, const uplink::Outcome& outcome);

/// The run uses all requests that the endpoint allows.
TestStep no_turn(const std::string& name);

/// By an answer's Date; `now`: the box's time of day.
TestStep clock(std::optional<std::chrono::sys_seconds> date, double now);
/// Without Date: by two readings of the run clock, in seconds.
TestStep run_clock(std::optional<double> first, std::optional<double> second);

TestStep skipped_step(const std::string& name, const std::string& why);

/// Largest difference that passes.
inline constexpr std::chrono::seconds kOff{2};

}  // namespace steps

/// The Test's steps at one endpoint, on its own connections. It requests the run's status, and posts `{}` as
/// a state, which the mapping endpoint rejects (ICD 6.5) after it has checked the token. It then posts `{}`
/// to a path that no Command Post has. Nothing is shown or recorded.
class EndpointTest {
 public:
  static constexpr std::chrono::milliseconds kReachWithin{3000}, kAnswerWithin{5000};
  /// Between requests to an endpoint, to avoid 429.
  static constexpr std::chrono::milliseconds kAskAgain{1500};
  /// Longest wait for one of the run's turns. After that the step is skipped.
  static constexpr std::chrono::seconds kLongestTurn{40};

  /// Turns at the run's endpoints: forward::Flow.
  struct Turns {
    std::function<bool(icd::Uri uri, const settings::Address& at)> are_shared;  // the run uses this endpoint
    std::function<std::optional<loop::Instant>(icd::Uri uri, loop::Instant latest)> claim;
    std::function<void(icd::Uri uri)> on_claimed;  // at the request, and at its end
  };

  /// `done` gets each step's result, now or later, and must not destroy this. The references outlive this.
  EndpointTest(loop::Loop& loop, const Turns& turns, const TestTarget& tried, steps::EndpointKind asked,
               std::function<void(api::TestStep)> done);

  // The steps. Each begins after the result of the one before.
  void reach();
  void check_token();
  void check_clock();

 private:
  /// The clocks of the endpoint by its last answer.
  struct Clocks {
    std::optional<std::chrono::sys_seconds> date;
    std::optional<double> run_clock;
    double answered_at = 0;  // by the box's time of day
  };

  void on_connected(int error, const std::string& why);
  void on_token_answer(const uplink::Outcome& outcome);
  void check_unknown_path(api::TestStep accepted, int status);
  void ask(const char* step, std::string_view path, std::function<void(uplink::Outcome)> done);
  void send(std::string_view path, std::function<void(uplink::Outcome)> done);

  icd::Uri uri() const {
    return asked_ == steps::EndpointKind::Scoring ? icd::Uri::Status : icd::Uri::StateUpdate;
  }
  const std::optional<icd::BearerToken>& token() const {
    return asked_ == steps::EndpointKind::Scoring ? tried_.scoring : tried_.mapping;
  }
  const settings::Address& address() const { return steps::address_in(tried_.post, asked_); }
  uplink::Endpoint tested_endpoint() const;

  loop::Loop& loop_;
  const Turns& turns_;
  const TestTarget& tried_;
  const steps::EndpointKind asked_;
  const std::function<void(api::TestStep)> done_;
  loop::Source timer_;
  std::function<void()> when_due_;
  loop::FileDescriptor socket_;
  loop::Source connecting_;
  std::unique_ptr<uplink::Connection> connection_;
  Clocks clocks_;
  bool asked_again_ = false;
  bool wants_slash_ = false;                  // at the end of each path
  std::optional<uplink::Outcome> page_ = {};  // the answer without a slash, if that was a web page
};

/// The Test, step by step on the loop, on its own connections: of the settings in use, or of a candidate,
/// whose tokens it forgets at the end. It changes no data at the Command Post.
class SelfTest final : public api::SelfTest {
 public:
  static constexpr std::chrono::milliseconds kProbeWithin{8000}, kProbePoll{100};
  using Turns = EndpointTest::Turns;

  /// `settings`: in use. `tried`: tried_of(), written settings. `changed`: after each step. All outlive this.
  SelfTest(loop::Loop& loop, const settings::Settings& settings,
           std::function<icd::Checked<TestTarget>(const api::Candidate&)> tried, Turns turns,
           const admin::NetworkChange& network, std::function<void()> changed);

  api::TestView state() const override { return view_; }
  icd::Checked<void> begin_test(const api::Candidate& candidate) override;
  /// Call when settings or tokens are applied. Marks the present result as outdated.
  void on_settings_changed() { view_.outdated = view_.number > 0; }

 private:
  enum class Phase : std::uint8_t { Link, Address, Cables, Reach, Token, Clock, End };

  /// A request to adit-network, and its answer.
  struct PendingProbe {
    network::Probe probe;
    std::optional<loop::Instant> until;  // while the answer is awaited
    std::optional<network::ProbeResult> found;
  };

  void list(steps::EndpointKind asked);
  void start_next();
  void run_step();
  void finish(api::TestStep step);
  void skip_the_rest(const std::string& why);
  api::TestedEndpoint& endpoint() { return view_.endpoints[tested_]; }

  void ask_address();
  void wait_for_probe();
  void check_cables();
  void reach();
  steps::EndpointKind kind() const { return asked_.at(tested_); }

  loop::Loop& loop_;
  const settings::Settings& settings_;
  std::function<icd::Checked<TestTarget>(const api::Candidate&)> tried_of_;
  const Turns turns_;
  TestTarget tried_;  // fixed during a test
  std::vector<steps::EndpointKind> asked_;
  const admin::NetworkChange& network_;
  std::function<void()> changed_;
  api::TestView view_;
  std::size_t tested_ = 0;  // index of the endpoint
  Phase at_ = Phase::End;
  loop::Source timer_;
  PendingProbe probing_;
  std::optional<EndpointTest> at_endpoint_;  // from Reach to End
};

}  // namespace adit::box
