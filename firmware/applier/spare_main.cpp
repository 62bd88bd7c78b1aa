/// adit-spare: copies exports for a spare box to and from a USB stick, as root, for aditd, which has no
/// privileges.

#include "applier/spare_keeper.hpp"
#include "command_line/answer.hpp"
#include "host/log.hpp"

int main(int argc, char** argv) {
  using adit::applier::spare_command_line_of;
  const auto options = adit::command_line::read(spare_command_line_of, {argv + 1, argv + argc});
  if (const auto exit = adit::command_line::answer(spare_command_line_of, ADIT_VERSION, options))
    return *exit;
  const auto done = adit::applier::SpareKeeper(*options).work();
  if (done) return 0;
  adit::host::log(adit::host::Level::Error, "cannot run", {{"why", done.error()}});
  return 1;
}
