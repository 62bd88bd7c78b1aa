/// adit-network: changes the box's addresses, for aditd, which has no privileges.

#include <csignal>
#include <optional>

#include "applier/address_watch.hpp"
#include "applier/applier.hpp"
#include "applier/options.hpp"
#include "command_line/read.hpp"
#include "host/log.hpp"
#include "host/systemd.hpp"
#include "loop/loop.hpp"
#include "loop/watchdog.hpp"

namespace {

bool is_well(const std::expected<void, std::string>& done) {
  return adit::host::log_failure(adit::host::Level::Error, "cannot run", done);
}

/// Runs until the box stops.
int watch(const adit::applier::Options& options) {
  adit::loop::Loop loop;
  adit::applier::AddressWatch watch(loop, options);
  const auto terminated = loop.signal(SIGTERM, [&loop] { loop.stop(); });
  const auto interrupted = loop.signal(SIGINT, [&loop] { loop.stop(); });
  if (!is_well(watch.start())) return 1;
  std::optional<adit::loop::Watchdog> watchdog;
  if (const auto within = adit::host::watchdog_within())
    watchdog.emplace(loop, *within, &adit::host::notify_alive);
  adit::host::notify_ready("listening");
  loop.run();
  return 0;
}

int run(const adit::applier::Options& options) {
  adit::loop::Loop loop;
  adit::applier::Applier applier(loop, options);
  const auto terminated = loop.signal(SIGTERM, [&applier] { applier.stop(); });
  const auto interrupted = loop.signal(SIGINT, [&applier] { applier.stop(); });
  if (!is_well(applier.start())) return 1;
  loop.run();
  return applier.is_done() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  using adit::applier::command_line_of;
  const auto options = adit::applier::parse_options({argv + 1, argv + argc});
  if (const auto exit =
          adit::command_line::answer<adit::applier::Options>(command_line_of, ADIT_VERSION, options))
    return *exit;
  if (options->watch) return watch(*options);
  if (!options->start) return run(*options);
  // Once at boot, before networkd.
  return is_well(adit::applier::NetworkdFiles(*options).write_at_start()) ? 0 : 1;
}
