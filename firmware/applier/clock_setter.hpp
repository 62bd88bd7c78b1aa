#pragma once

#include <expected>
#include <functional>
#include <string>

#include "applier/chronyd.hpp"
#include "applier/options.hpp"
#include "clock/messages.hpp"
#include "host/root_program.hpp"
#include "host/untrusted_folder.hpp"

namespace adit::applier {

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

  /// Answers all requests, then returns. Error: its own directory is unusable, or a request cannot be
  /// removed.
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
