#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "admin/network_change.hpp"
#include "api/self_test.hpp"
#include "box/candidate.hpp"
#include "box/test_steps.hpp"
#include "icd/uri.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "settings/settings.hpp"
#include "uplink/connection.hpp"

namespace adit::box {

/// The Test, step by step on the loop, on its own connections: of the settings in use, or of a candidate,
/// whose tokens it forgets at the end. It changes no data at the Command Post. It requests the run's status,
/// and posts `{}` as a state, which the mapping endpoint rejects (ICD 5.2) after it has checked the token.
class SelfTest final : public api::SelfTest {
 public:
  static constexpr std::chrono::milliseconds kReachWithin{3000}, kAnswerWithin{5000};
  static constexpr std::chrono::milliseconds kProbeWithin{8000}, kProbePoll{100};
  /// Between requests to an endpoint, to avoid 429.
  static constexpr std::chrono::milliseconds kAskAgain{1500};

  /// Longest wait for one of the run's turns. After that the step is skipped.
  static constexpr std::chrono::seconds kLongestTurn{40};

  /// Turns at the run's endpoints: forward::Flow.
  struct Turns {
    std::function<std::optional<loop::Instant>(icd::Uri uri, loop::Instant latest)> claim;
    std::function<void(icd::Uri uri)> claimed;  // at the request, and at its end
  };

  /// `settings`: in use. `tried`: tried_of() with the written settings. `changed`: after each step. All
  /// outlive this.
  SelfTest(loop::Loop& loop, const settings::Settings& settings,
           std::function<icd::Checked<TestTarget>(const api::Candidate&)> tried, Turns turns,
           host::RootProgram<network::Status>& adit_network, const admin::NetworkChange& network,
           std::function<void()> changed);

  api::TestView test() const override { return view_; }
  icd::Checked<void> begin_test(const api::Candidate& candidate) override;
  /// Call when settings or tokens are applied. Marks the present result as outdated.
  void settings_changed() { view_.outdated = view_.number > 0; }

 private:
  enum class At : std::uint8_t { Link, Address, Cables, Reach, Token, Clock, End };

  void list(steps::Asked asked);
  void next();
  void run_step();
  void finish(api::TestStep step);
  void skip_the_rest(const std::string& why);
  api::TestedEndpoint& endpoint() { return view_.endpoints[tested_]; }

  void ask_address();
  void wait_for_probe();
  void look_at_cables();
  void connect();
  void connected(int error, const std::string& why);
  void ask_token();
  void token_answered(const uplink::Outcome& outcome);
  void ask_clock();
  void ask_again();
  void ask(std::function<void(uplink::Outcome)> done);
  void send(std::function<void(uplink::Outcome)> done);
  void over();

  steps::Asked kind() const { return asked_.at(tested_); }
  icd::Uri uri() const { return kind() == steps::Asked::Scoring ? icd::Uri::Status : icd::Uri::StateUpdate; }
  const std::optional<icd::BearerToken>& token() const {
    return kind() == steps::Asked::Scoring ? tried_.scoring : tried_.mapping;
  }
  const settings::Address& address() const { return steps::address_in(tried_.post, kind()); }
  bool is_of_the_run() const { return address() == steps::address_in(settings_.command_post, kind()); }
  uplink::Endpoint there() const;

  loop::Loop& loop_;
  const settings::Settings& settings_;
  std::function<icd::Checked<TestTarget>(const api::Candidate&)> tried_of_;
  Turns turns_;
  TestTarget tried_;  // fixed during a test
  std::vector<steps::Asked> asked_;
  host::RootProgram<network::Status>& adit_network_;
  const admin::NetworkChange& network_;
  std::function<void()> changed_;
  api::TestView view_;
  std::size_t tested_ = 0;  // index of the endpoint
  At at_ = At::End;

  loop::Source timer_;
  std::function<void()> when_due_;
  network::Probe probe_;
  std::optional<network::Probed> probed_;
  loop::Instant until_{};
  loop::FileDescriptor socket_;
  loop::Source connecting_;
  std::unique_ptr<uplink::Connection> connection_;
  std::optional<std::chrono::sys_seconds> date_;
  double answered_at_ = 0;
  std::optional<double> run_clock_;
  bool asked_again_ = false;
  bool wants_slash_ = false;  // at the end of each path
};

}  // namespace adit::box
