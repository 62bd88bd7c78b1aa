/// adit-update: installs updates of the box, as root, for aditd, which has no privilege.

#include <cstdio>

#include "applier/health_watch.hpp"
#include "applier/update_options.hpp"
#include "applier/updater.hpp"
#include "host/log.hpp"

int main(int argc, char** argv) {
  const auto options = adit::applier::parse_update_options(
      std::span<char* const>(argv + 1, static_cast<std::size_t>(argc - 1)));
  if (!options) {
    std::fprintf(stderr, "adit-update: %s\n%s", options.error().c_str(), adit::applier::kUpdateUsage);
    return 2;
  }
  if (options->help) return std::fputs(adit::applier::kUpdateUsage, stdout) < 0 ? 1 : 0;
  if (options->version) return std::printf("adit-update %s\n", ADIT_VERSION) < 0 ? 1 : 0;
  const auto done =
      options->good ? adit::applier::watch_health(*options) : adit::applier::Updater(*options).work();
  if (done) return 0;
  adit::host::log(adit::host::Level::Error, "cannot work", {{"why", done.error()}});
  return 1;
}
