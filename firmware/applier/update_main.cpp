/// adit-update: installs updates of the box as root, for aditd, which has no privileges.

#include "applier/health_watch.hpp"
#include "applier/options.hpp"
#include "applier/updater.hpp"
#include "command_line/answer.hpp"
#include "host/log.hpp"

int main(int argc, char** argv) {
  using namespace adit;
  using namespace adit::applier;
  return command_line::run<UpdateOptions>(
      command_line_of, ADIT_VERSION, argc, argv, [](const UpdateOptions& options) {
        const auto done = options.good ? watch_health(options) : Updater(options).work();
        return host::log_failure(host::Level::Error, "cannot run", done) ? 0 : 1;
      });
}
