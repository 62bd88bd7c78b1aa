/// adit-update: installs updates of the box, as root, for aditd, which has no privilege.

#include "applier/health_watch.hpp"
#include "applier/update_options.hpp"
#include "applier/updater.hpp"
#include "host/command_line.hpp"
#include "host/log.hpp"

int main(int argc, char** argv) {
  const auto options = adit::applier::parse_update_options(
      std::span<char* const>(argv + 1, static_cast<std::size_t>(argc - 1)));
  if (const auto exit =
          adit::host::answered("adit-update", ADIT_VERSION, adit::applier::kUpdateUsage, options))
    return *exit;
  const auto done =
      options->good ? adit::applier::watch_health(*options) : adit::applier::Updater(*options).work();
  if (done) return 0;
  adit::host::log(adit::host::Level::Error, "cannot work", {{"why", done.error()}});
  return 1;
}
