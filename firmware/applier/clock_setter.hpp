#pragma once

#include <expected>
#include <functional>
#include <string>

#include "applier/chronyd.hpp"
#include "applier/clock_options.hpp"
#include "clock/messages.hpp"
#include "host/root_program.hpp"
#include "host/untrusted_folder.hpp"

namespace adit::applier {

/// The clocks of the machine, in seconds: since 1970, and of the monotonic one.
struct Clocks {
  std::function<double()> wall, monotonic;
  /// Sets the first. An error says why it cannot.
  std::function<std::expected<void, std::string>(double)> set;
  /// The same time into a clock with a battery, where there is one.
  std::function<void(double)> set_chip;
  std::string boot;  // host::boot()
};
/// Those of this machine. `chip_device`: its clock with a battery.
Clocks clocks_of_machine(const std::string& chip_device);

/// adit-clock at work: sets the time of day as aditd asks, and tells who set it last.
class ClockSetter {
 public:
  /// `options` outlive this.
  ClockSetter(const ClockOptions& options, Clocks clocks)
      : options_(options),
        clocks_(std::move(clocks)),
        file_(options.status + '/' + host::kStatusFile),
        chronyd_(options.status, options.team, options.systemctl) {}

  /// Until nothing is asked for. An error: its own folder is not as it should be, or what is asked for cannot
  /// be taken away.
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
