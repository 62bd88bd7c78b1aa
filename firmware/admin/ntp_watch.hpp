#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "clock/tracking.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"

namespace adit::admin {

/// Asks chronyd on this machine about an NTP server (firmware/clock/README.md).
class NtpWatch {
 public:
  /// Age of chronyd's last contact at which the server is silent: at least three unanswered packets.
  static constexpr double kSilence = 150;  // seconds
  /// Age of chronyd's last answer at which chronyd is not running.
  static constexpr std::chrono::seconds kGone{15};

  /// `port`: of chronyd. `loop` must outlive this object.
  explicit NtpWatch(loop::Loop& loop, std::uint16_t port = 323) : loop_(loop), port_(port) {}

  /// Call each second. `server`: an IPv4 address, or "" to stop asking.
  void every_second(const std::string& server);
  /// Seconds by which the system clock is behind the server. std::nullopt: the server is silent.
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
  bool is_asked_ = false;  // the last request has no answer
  loop::FileDescriptor socket_;
  loop::Source answers_;  // destroyed before its descriptor is closed
};

}  // namespace adit::admin
