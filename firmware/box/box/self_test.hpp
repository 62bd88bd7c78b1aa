#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "admin/network_change.hpp"
#include "api/self_test.hpp"
#include "box/candidate.hpp"
#include "box/endpoint_test.hpp"
#include "box/test_steps.hpp"
#include "loop/loop.hpp"
#include "settings/settings.hpp"

namespace adit::box {

/// The Test, step by step on the loop, on its own connections: of the settings in use, or of a candidate,
/// whose tokens it forgets at the end. It changes no data at the Command Post.
class SelfTest final : public api::SelfTest {
 public:
  static constexpr std::chrono::milliseconds kProbeWithin{8000}, kProbePoll{100};
  using Turns = EndpointTest::Turns;

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

  /// A request to adit-network, and its answer.
  struct Probing {
    network::Probe probe;
    std::optional<loop::Instant> until;  // while the answer is awaited
    std::optional<network::Probed> found;
  };

  void list(steps::Asked asked);
  void next();
  void run_step();
  void finish(api::TestStep step);
  void skip_the_rest(const std::string& why);
  api::TestedEndpoint& endpoint() { return view_.endpoints[tested_]; }

  void ask_address();
  void wait_for_probe();
  void look_at_cables();
  void reach();
  steps::Asked kind() const { return asked_.at(tested_); }

  loop::Loop& loop_;
  const settings::Settings& settings_;
  std::function<icd::Checked<TestTarget>(const api::Candidate&)> tried_of_;
  const Turns turns_;
  TestTarget tried_;  // fixed during a test
  std::vector<steps::Asked> asked_;
  host::RootProgram<network::Status>& adit_network_;
  const admin::NetworkChange& network_;
  std::function<void()> changed_;
  api::TestView view_;
  std::size_t tested_ = 0;  // index of the endpoint
  At at_ = At::End;
  loop::Source timer_;
  Probing probing_;
  std::optional<EndpointTest> at_endpoint_;  // from Reach to End
};

}  // namespace adit::box
