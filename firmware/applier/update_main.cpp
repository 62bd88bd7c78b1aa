/// adit-update: installs updates of the box as root, for aditd, which has no privileges.

#include "applier/health_watch.hpp"
#include "applier/update_options.hpp"
#include "applier/updater.hpp"
#include "command_line/answer.hpp"
#include "host/log.hpp"

int main(int argc, char** argv) {
  using adit::applier::update_command_line_of;
  const auto options = adit::command_line::read(update_command_line_of, {argv + 1, argv + argc});
  if (const auto exit = adit::command_line::answer(update_command_line_of, ADIT_VERSION, options))
    return *exit;
  const auto done =
      options->good ? adit::applier::watch_health(*options) : adit::applier::Updater(*options).work();
  if (done) return 0;
  adit::host::log(adit::host::Level::Error, "cannot run", {{"why", done.error()}});
  return 1;
}
