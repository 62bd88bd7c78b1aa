#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "api/self_test.hpp"
#include "box/candidate.hpp"
#include "box/test_steps.hpp"
#include "icd/uri.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "settings/settings.hpp"
#include "uplink/connection.hpp"

namespace adit::box {

/// The Test's steps at one endpoint, on its own connections. It requests the run's status, and posts `{}` as
/// a state, which the mapping endpoint rejects (ICD 5.2) after it has checked the token.
class EndpointTest {
 public:
  static constexpr std::chrono::milliseconds kReachWithin{3000}, kAnswerWithin{5000};
  /// Between requests to an endpoint, to avoid 429.
  static constexpr std::chrono::milliseconds kAskAgain{1500};
  /// Longest wait for one of the run's turns. After that the step is skipped.
  static constexpr std::chrono::seconds kLongestTurn{40};

  /// Turns at the run's endpoints: forward::Flow.
  struct Turns {
    std::function<std::optional<loop::Instant>(icd::Uri uri, loop::Instant latest)> claim;
    std::function<void(icd::Uri uri)> claimed;  // at the request, and at its end
  };

  /// `in_use`: the Command Post of the settings in use. `done` gets the result of each step, within its call
  /// or later, and must not destroy this object. The references must outlive this object.
  EndpointTest(loop::Loop& loop, const Turns& turns, const settings::CommandPost& in_use,
               const TestTarget& tried, steps::Asked asked, std::function<void(api::TestStep)> done);

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

  void connected(int error, const std::string& why);
  void token_answered(const uplink::Outcome& outcome);
  void ask(const char* step, std::function<void(uplink::Outcome)> done);
  void send(std::function<void(uplink::Outcome)> done);

  icd::Uri uri() const { return asked_ == steps::Asked::Scoring ? icd::Uri::Status : icd::Uri::StateUpdate; }
  const std::optional<icd::BearerToken>& token() const {
    return asked_ == steps::Asked::Scoring ? tried_.scoring : tried_.mapping;
  }
  const settings::Address& address() const { return steps::address_in(tried_.post, asked_); }
  bool is_of_the_run() const { return address() == steps::address_in(in_use_, asked_); }
  uplink::Endpoint there() const;

  loop::Loop& loop_;
  const Turns& turns_;
  const settings::CommandPost& in_use_;
  const TestTarget& tried_;
  const steps::Asked asked_;
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

}  // namespace adit::box
