#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "clock/tracking.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"

namespace adit::admin {

/// Asks chronyd, on this machine, how it stands with an NTP server (firmware/clock/README.md).
class NtpWatch {
 public:
  /// Three of its questions without an answer, at least.
  static constexpr double kSilence = 150;  // seconds
  /// A chronyd that has not answered for so long does not run.
  static constexpr std::chrono::seconds kGone{15};

  /// `port`: where chronyd answers. `loop` outlives this.
  explicit NtpWatch(loop::Loop& loop, std::uint16_t port = 323) : loop_(loop), port_(port) {}

  /// Called each second: `server` is to be heard, an IPv4 address; "": nobody is, and nothing is asked.
  void every_second(const std::string& server);
  /// Seconds by which the system's clock is behind the server's; nothing: it is not heard.
  std::optional<double> behind() const;

 private:
  void ask();
  void hear();
  double system_now() const { return loop_.wall_now() - loop_.wall_ahead(); }

  loop::Loop& loop_;
  const std::uint16_t port_;
  std::optional<std::uint32_t> server_;
  std::optional<clock::Tracking> told_;
  loop::Instant told_at_{}, asked_at_{};
  std::uint32_t number_ = 0;
  bool is_asked_ = false;  // and has not answered
  loop::FileDescriptor socket_;
  loop::Source answers_;  // ended before its descriptor is closed
};

}  // namespace adit::admin
