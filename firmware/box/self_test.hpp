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

/// The Test, step by step on the loop, on connections of its own: of what is in use, or of what an operator
/// is about to apply, whose tokens are forgotten once it is over. It asks nothing that changes anything at
/// the Command Post: the scoring endpoint for the run's status, the mapping endpoint to take `{}` for a
/// state, which it refuses as it lacks everything (ICD 5.2), but only once it has looked at the token.
class SelfTest final : public api::SelfTest {
 public:
  static constexpr std::chrono::milliseconds kReachWithin{3000}, kAnswerWithin{5000};
  static constexpr std::chrono::milliseconds kProbeWithin{8000}, kProbePoll{100};
  /// Between two questions to the scoring endpoint, so that it does not answer 429.
  static constexpr std::chrono::milliseconds kAskAgain{1500};

  /// So long a question to an endpoint of the run waits for its turn among the run's own; then it is not
  /// asked.
  static constexpr std::chrono::seconds kLongestTurn{40};

  /// How it asks an endpoint that the run uses, too: forward::Flow.
  struct Turns {
    std::function<std::optional<loop::Instant>(icd::Uri uri, loop::Instant latest)> claim;
    std::function<void(icd::Uri uri)> claimed;  // it leaves; it was answered, or not
  };

  /// `settings`: as they are in use. `tried`: tried_of() beside those that are written. `changed` is called
  /// as steps end. All outlive this.
  SelfTest(loop::Loop& loop, const settings::Settings& settings,
           std::function<icd::Checked<Tried>(const api::Candidate&)> tried, Turns turns,
           host::RootProgram<network::Status>& adit_network, const admin::NetworkChange& network,
           std::function<void()> changed);

  api::TestView test() const override { return view_; }
  icd::Checked<void> begin_test(const api::Candidate& candidate) override;
  /// Call when settings or tokens are applied: the result, or that of the test that runs, is of those before.
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
  std::function<icd::Checked<Tried>(const api::Candidate&)> tried_of_;
  Turns turns_;
  Tried tried_;  // whatever the settings say by now
  std::vector<steps::Asked> asked_;
  host::RootProgram<network::Status>& adit_network_;
  const admin::NetworkChange& network_;
  std::function<void()> changed_;
  api::TestView view_;
  std::size_t tested_ = 0;  // which endpoint
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
  bool wants_slash_ = false;  // the endpoint, at the end of each path
};

}  // namespace adit::box
