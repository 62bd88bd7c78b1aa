/// adit-spare: copies exports for a spare box to and from a USB stick, as root, for aditd, which has no
/// privileges.

#include "applier/options.hpp"
#include "applier/spare_keeper.hpp"
#include "command_line/answer.hpp"
#include "host/log.hpp"

int main(int argc, char** argv) {
  using namespace adit;
  using namespace adit::applier;
  return command_line::run<SpareOptions>(
      command_line_of, ADIT_VERSION, argc, argv, [](const SpareOptions& options) {
        return host::log_failure(host::Level::Error, "cannot run", SpareKeeper(options).work()) ? 0 : 1;
      });
}
