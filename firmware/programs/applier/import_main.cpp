/// adit-import: imports a user's files from the boot partition, as root, before aditd starts.

#include "applier/import.hpp"
#include "command_line/read.hpp"
#include "host/log.hpp"

int main(int argc, char** argv) {
  using namespace adit;
  using namespace adit::applier;
  return command_line::run<ImportOptions>(
      command_line_of, ADIT_VERSION, argc, argv, [](const ImportOptions& options) {
        return host::log_failure(host::Level::Error, "cannot accept the card's files", Import(options).run())
                   ? 0
                   : 1;
      });
}
