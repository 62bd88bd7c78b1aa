#pragma once

#include <expected>
#include <functional>
#include <string>

#include "applier/options.hpp"
#include "clock/chrony.hpp"
#include "clock/messages.hpp"
#include "host/root_program.hpp"
#include "host/untrusted_folder.hpp"

namespace adit::applier {

/// chronyd, run by systemd (adit-ntp.service) from files written here.
class Chronyd {
 public:
  /// `folder`: for these files alone. `interface`: the team's.
  Chronyd(std::string folder, std::string interface, std::string systemctl)
      : folder_(std::move(folder)), interface_(std::move(interface)), systemctl_(std::move(systemctl)) {}

  /// Starts, restarts or stops chronyd as needed. Returns why that failed, or "".
  std::string run_with(const clock::Ntp& ntp, clock::Source source) const;

 private:
  std::string start(const clock::Chrony& chrony) const;
  std::string stop() const;
  std::string path(const char* name) const { return folder_ + '/' + name; }

  std::string folder_, interface_, systemctl_;
};

/// The machine's clocks, in seconds: wall time since 1970, and monotonic time.
struct Clocks {
  std::function<double()> wall, monotonic;
  /// Sets the wall clock.
  std::function<std::expected<void, std::string>(double)> set;
  /// Sets the battery clock, if there is one.
  std::function<void(double)> set_chip;
  std::string boot;  // host::boot()
};
/// `chip_device`: the battery clock.
Clocks clocks_of_machine(const std::string& chip_device);

/// The work of adit-clock: sets the time of day on aditd's request, and reports the source.
class ClockSetter {
 public:
  /// `options` must outlive this object.
  ClockSetter(const ClockOptions& options, Clocks clocks)
      : options_(options),
        clocks_(std::move(clocks)),
        file_(options.status + '/' + host::kStatusFile),
        chronyd_(options.status, options.team, options.systemctl) {}

  /// Answers all requests, then returns. Error: its directory is unusable, or a request cannot be removed.
  std::expected<void, std::string> work();

 private:
  void answer(const clock::Request& request);

  const ClockOptions& options_;
  Clocks clocks_;
  clock::Status status_;
  host::StatusFile file_;
  Chronyd chronyd_;
};

}  // namespace adit::applier
