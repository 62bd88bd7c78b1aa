#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "api/clock.hpp"
#include "clock/chrony.hpp"
#include "clock/messages.hpp"
#include "host/root_program.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"

namespace adit::admin {

/// Asks chronyd on this machine about an NTP server (firmware/rules/clock/README.md).
class NtpWatch {
 public:
  /// Age of chronyd's last contact at which the server is silent: at least three unanswered packets.
  static constexpr double kSilence = 150;  // seconds
  /// Age of chronyd's last answer at which chronyd is not running.
  static constexpr std::chrono::seconds kGone{15};

  /// `port`: of chronyd. `loop` must outlive this object.
  NtpWatch(loop::Loop& loop, std::uint16_t port) : loop_(loop), port_(port) {}

  /// Call each second. `server`: an IPv4 address, or "" to stop asking.
  void every_second(const std::string& server);
  /// Seconds by which the system clock is behind the server. std::nullopt: the server is silent.
  std::optional<double> offset() const;

 private:
  void ask();
  void read_answers();
  double system_now() const { return loop_.wall_now() - loop_.wall_offset(); }

  loop::Loop& loop_;
  const std::uint16_t port_;
  std::optional<std::uint32_t> server_;
  std::optional<clock::Tracking> told_;
  loop::Instant told_at_{}, asked_at_{};
  std::uint32_t number_ = 0;
  bool is_asked_ = false;  // the last request has no answer
  loop::FileDescriptor socket_;
  loop::Source answers_;  // destroyed before its descriptor is closed
};

/// The time of day, which adit-clock sets (firmware/rules/clock/README.md).
class ClockSetting final : public api::Clock {
 public:
  static constexpr std::uint16_t kChronyd = 323;  // chronyd's port on this machine

  /// Age at which adit-clock rejects a request. A busy box takes half a minute.
  static constexpr std::chrono::seconds kTakenUpWithin{60};
  /// Wait before an unanswered or failed request is repeated.
  static constexpr std::chrono::seconds kAskAgain{60};

  /// `state_folder`: requests. `status_folder`: answers. `units`: host::kStartedAtBoot. `loop` outlives this.
  ClockSetting(loop::Loop& loop, const std::string& state_folder, const std::string& status_folder,
               std::uint16_t chronyd, const std::string& units = host::kStartedAtBoot)
      : loop_(loop),
        adit_clock_(loop, "adit-clock", state_folder, status_folder, kTakenUpWithin, units),
        watch_(loop, chronyd) {}

  api::ClockView state() const override;
  icd::Checked<void> set_clock(double time) override;

  /// Call each second. `ntp`: from the settings.
  void every_second(const clock::Ntp& ntp);
  /// Requests the offered time if time_to_set() accepts it.
  void on_offered(const clock::Offer& offer);
  /// std::nullopt: adit-clock is starting or does not run here, and the time may be right.
  std::optional<bool> is_set() const;
  /// Whether another source than the box's own clock has set the time of day.
  bool has_source() const;
  /// Why NTP does not follow the settings, as a sentence; or "".
  std::string ntp_trouble() const;

 private:
  std::expected<void, std::string> ask(clock::Source source, double time);
  /// Why the last request was not read, or "".
  std::string trouble() const { return not_written_.empty() ? adit_clock_.trouble() : not_written_; }
  void ask_for_ntp();
  void follow_ntp();
  bool is_kept_by_ntp() const;
  std::string ntp_text() const;

  loop::Loop& loop_;
  host::RootProgram<clock::Status> adit_clock_;
  NtpWatch watch_;
  clock::Ntp ntp_;  // from the settings
  loop::Instant ntp_asked_at_{}, ntp_since_{};
  loop::Instant asked_at_{};
  std::string not_written_;  // why the last request could not be written, or ""
};

}  // namespace adit::admin
