#pragma once

#include <expected>
#include <optional>
#include <string>

#include "api/clock.hpp"
#include "clock/messages.hpp"
#include "loop/loop.hpp"

namespace adit::admin {

/// The time of day, as adit-clock sets it (firmware/clock/README.md).
class ClockSetting final : public api::Clock {
 public:
  static constexpr std::chrono::seconds kTakenUpWithin{20};

  /// `state_folder`: where requests are left; `status_folder`: where they are answered. `loop` outlives this.
  ClockSetting(loop::Loop& loop, const std::string& state_folder, const std::string& status_folder)
      : loop_(loop),
        request_(state_folder + '/' + clock::kRequestFile),
        status_file_(status_folder + '/' + clock::kStatusFile) {}

  api::ClockView clock() const override;
  icd::Checked<void> set_clock(double time) override;

  /// Called each second.
  void every_second();
  /// That source tells that time now: it is taken where to_be_set() says so.
  void offered(const clock::Offer& offer);
  /// Nothing: it is not set here, and nobody knows.
  std::optional<bool> is_set() const;

 private:
  std::expected<void, std::string> ask(clock::Source source, double time);
  void give_up();

  loop::Loop& loop_;
  std::string request_, status_file_;
  std::expected<clock::Status, std::string> status_ = std::unexpected("nobody has looked yet");
  std::string asked_;  // the nonce of what is not in the status yet; "": nothing
  loop::Instant asked_at_{};
  std::string not_taken_up_;
};

}  // namespace adit::admin
