/// adit-clock: sets the time of day as root, for aditd, which has no privileges.

#include "applier/clock_setter.hpp"
#include "applier/options.hpp"
#include "command_line/read.hpp"
#include "host/log.hpp"

int main(int argc, char** argv) {
  using namespace adit;
  using namespace adit::applier;
  return command_line::run<ClockOptions>(
      command_line_of, ADIT_VERSION, argc, argv, [](const ClockOptions& options) {
        return host::log_failure(host::Level::Error, "cannot run",
                                 ClockSetter(options, clocks_of_machine(options.chip_device)).work())
                   ? 0
                   : 1;
      });
}
