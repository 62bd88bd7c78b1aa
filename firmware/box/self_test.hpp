#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "admin/network_change.hpp"
#include "admin/network_requests.hpp"
#include "api/self_test.hpp"
#include "box/test_steps.hpp"
#include "icd/bearer_token.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "settings/settings.hpp"
#include "uplink/connection.hpp"

namespace adit::box {

/// The Test, step by step on the loop. It asks nothing that changes anything at the Command Post: the scoring
/// endpoint for the run's status, the mapping endpoint to take `{}` for a state, which it refuses as it lacks
/// everything (ICD 5.2), but only once it has looked at the token.
class SelfTest final : public api::SelfTest {
 public:
  static constexpr std::chrono::milliseconds kReachWithin{3000}, kAnswerWithin{5000};
  static constexpr std::chrono::milliseconds kProbeWithin{8000}, kProbePoll{100};
  /// Between two questions to the scoring endpoint, so that it does not answer 429.
  static constexpr std::chrono::milliseconds kAskAgain{1500};

  struct Tokens {
    std::optional<icd::BearerToken> scoring, mapping;
  };

  /// `changed` is called as steps end. All outlive this.
  SelfTest(loop::Loop& loop, const settings::Settings& settings, Tokens tokens,
           admin::NetworkRequests& requests, const admin::NetworkChange& network,
           std::function<void()> changed);

  /// For tests that begin from now on.
  void use(Tokens tokens) { tokens_ = std::move(tokens); }

  api::TestView test() const override { return view_; }
  bool begin_test() override;

 private:
  enum class At : std::uint8_t { Link, Address, Cables, Reach, Token, Clock, End };

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

  steps::Asked kind() const { return tested_ == 0 ? steps::Asked::Scoring : steps::Asked::Mapping; }
  const std::optional<icd::BearerToken>& token() const {
    return tested_ == 0 ? shown_.scoring : shown_.mapping;
  }
  uplink::Endpoint there() const;

  loop::Loop& loop_;
  const settings::Settings& settings_;
  Tokens tokens_;
  settings::CommandPost post_;  // that is tested, whatever the settings say by now
  Tokens shown_;                // to it
  admin::NetworkRequests& requests_;
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
};

}  // namespace adit::box
