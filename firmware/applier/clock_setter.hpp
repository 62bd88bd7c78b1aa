#pragma once

#include <expected>
#include <functional>
#include <string>

#include "applier/clock_options.hpp"
#include "applier/status_file.hpp"
#include "clock/messages.hpp"

namespace adit::applier {

/// The clocks of the machine, in seconds: since 1970, and of the monotonic one.
struct Clocks {
  std::function<double()> wall, monotonic;
  /// Sets the first. An error says why it cannot.
  std::function<std::expected<void, std::string>(double)> set;
};
/// Those of this machine. `chip_device`: a clock with a battery, which is set too, where it can be.
Clocks clocks_of_machine(const std::string& chip_device);

/// adit-clock at work: sets the time of day as aditd asks, and tells who set it last.
class ClockSetter {
 public:
  /// `options` outlive this.
  ClockSetter(const ClockOptions& options, Clocks clocks)
      : options_(options), clocks_(std::move(clocks)), file_(options.status + '/' + clock::kStatusFile) {}

  /// Until nothing is asked for. An error: its own folder is not as it should be, or what is asked for cannot
  /// be taken away.
  std::expected<void, std::string> work();

 private:
  void answer(const clock::Request& request);

  const ClockOptions& options_;
  Clocks clocks_;
  clock::Status status_;
  StatusFile file_;
};

}  // namespace adit::applier
