/// adit-clock: sets the time of day as root, for aditd, which has no privileges.

#include "applier/clock_options.hpp"
#include "applier/clock_setter.hpp"
#include "command_line/answer.hpp"
#include "host/log.hpp"

int main(int argc, char** argv) {
  using adit::applier::clock_command_line_of;
  const auto options = adit::command_line::read(clock_command_line_of, {argv + 1, argv + argc});
  if (const auto exit = adit::command_line::answer(clock_command_line_of, ADIT_VERSION, options))
    return *exit;
  const auto done =
      adit::applier::ClockSetter(*options, adit::applier::clocks_of_machine(options->chip_device)).work();
  if (done) return 0;
  adit::host::log(adit::host::Level::Error, "cannot run", {{"why", done.error()}});
  return 1;
}
