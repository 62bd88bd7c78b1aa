#pragma once

#include <optional>
#include <string>

#include "admin/ntp_watch.hpp"
#include "api/clock.hpp"
#include "clock/messages.hpp"
#include "host/root_program.hpp"
#include "loop/loop.hpp"

namespace adit::admin {

/// The time of day, as adit-clock sets it (firmware/clock/README.md).
class ClockSetting final : public api::Clock {
 public:
  static constexpr std::uint16_t kChronyd = 323;  // its port on this machine

  /// A request: when it is older, adit-clock refuses it. A busy box takes half a minute.
  static constexpr std::chrono::seconds kTakenUpWithin{60};
  /// After this time a request that adit-clock did not take up, or that failed, is made again.
  static constexpr std::chrono::seconds kAskAgain{60};

  /// `state_folder`: where requests are left; `status_folder`: where they are answered. `loop` outlives this.
  ClockSetting(loop::Loop& loop, const std::string& state_folder, const std::string& status_folder,
               std::uint16_t chronyd)
      : loop_(loop),
        adit_clock_(loop, "adit-clock", state_folder, status_folder, kTakenUpWithin),
        watch_(loop, chronyd) {}

  api::ClockView clock() const override;
  icd::Checked<void> set_clock(double time) override;

  /// Called each second, with what the settings ask of NTP.
  void every_second(const clock::Ntp& ntp);
  /// That source tells that time now: it is taken where to_be_set() says so.
  void offered(const clock::Offer& offer);
  /// Nothing: it is not set here, and nobody knows.
  std::optional<bool> is_set() const;
  /// Why NTP is not as the settings have it, a sentence; or "".
  std::string ntp_trouble() const;

 private:
  std::expected<void, std::string> ask(clock::Source source, double time);
  /// Why the last request was not read; or "".
  std::string trouble() const { return not_written_.empty() ? adit_clock_.trouble() : not_written_; }
  void ask_for_ntp();
  void follow_ntp();
  bool is_kept_by_ntp() const;
  std::string ntp_said() const;

  loop::Loop& loop_;
  host::RootProgram<clock::Status> adit_clock_;
  NtpWatch watch_;
  clock::Ntp ntp_;  // as the settings have it
  loop::Instant ntp_asked_at_{}, ntp_since_{};
  loop::Instant asked_at_{};
  std::string not_written_;  // why the last request could not be written; or ""
};

}  // namespace adit::admin
