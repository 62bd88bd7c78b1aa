/// adit-update: installs updates of the box as root, for aditd, which has no privileges.

#include <chrono>
#include <expected>
#include <string>
#include <thread>

#include "applier/options.hpp"
#include "applier/updater.hpp"
#include "command_line/read.hpp"
#include "host/log.hpp"
#include "host/output.hpp"
#include "host/service.hpp"
#include "icd/try.hpp"
#include "update/health.hpp"

namespace adit::applier {
namespace {

using host::Level;

constexpr std::chrono::seconds kSystemctlAnswer{30};
/// Interval of questions to systemd: for a slot on trial, and for a slot that lacks only its settings.
constexpr std::chrono::seconds kOnTrial{2}, kElse{10};

std::chrono::microseconds now() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
      std::chrono::steady_clock::now().time_since_epoch());  // CLOCK_MONOTONIC, as systemd uses
}

update::Ready ready(const std::string& systemctl) {
  const auto said = host::output_of(
      {systemctl, "show", "--property=ActiveState,ActiveEnterTimestampMonotonic", "adit.service"},
      kSystemctlAnswer);
  return update::read_ready(said.out, now());
}

std::expected<void, std::string> restart(const std::string& systemctl) {
  host::log(Level::Error, "the slot on trial did not become healthy in time: restarting the machine");
  auto restarted = host::run_command({systemctl, "reboot"}, kSystemctlAnswer);
  if (restarted) return restarted;
  return std::unexpected("cannot restart the machine: " + restarted.error());
}

/// A failure to store this does not change the slot's state: a later start stores it. Only a trial or the
/// operator replaces an unreadable record.
void keep_proven(const UpdateOptions& options, const update::Running& running, bool trial) {
  const auto before = load_proven(options.state);
  if (!before && !trial) return;  // adit-update reports it
  const update::Proven proven = update::proven_now(before.value_or(update::Proven{}), running, trial);
  if (!before || proven != *before) save(options.state, proven);
}

std::expected<void, std::string> pass_trial(const UpdateOptions& options, update::LastUpdate last_update) {
  host::log(Level::Notice, "the update is healthy",
            {{"version", last_update.version}, {"slot", last_update.slot}});
  last_update.stage = update::Stage::Good;
  last_update.why.clear();  // of an end that adit-update has not settled
  if (!save(options.state, last_update)) return std::unexpected("cannot store the end of the trial");
  return {};
}

/// adit-update writes the status and ends RAUC's service.
void start_adit_update(const std::string& systemctl) {
  host::output_of({systemctl, "start", "--no-block", "adit-update.service"}, kSystemctlAnswer);
}

/// `adit-update good`: waits until the running slot is good and marks it so, or restarts the machine.
std::expected<void, std::string> watch_health(const UpdateOptions& options) {
  const Rauc rauc(options.rauc);
  auto running = ADIT_TRY(rauc.status());
  running.version = version_in(options.os_release);
  const auto last_update = load_last_update(options.state);
  if (!last_update) host::log(Level::Error, "a trial would not be noticed", {{"why", last_update.error()}});
  const bool trial = last_update && update::on_trial(*last_update, running, host::boot());
  const auto late_at = now() + options.within;
  while (true) {
    const auto health = update::classify(trial, ready(options.systemctl), now() >= late_at);
    if (health == update::Health::Restart) return restart(options.systemctl);
    if (health == update::Health::Good) break;
    std::this_thread::sleep_for(trial ? kOnTrial : kElse);
  }
  ADIT_TRY(rauc.mark_good());
  keep_proven(options, running, trial);
  auto passed = trial ? pass_trial(options, *last_update) : std::expected<void, std::string>{};
  if (passed) start_adit_update(options.systemctl);
  return passed;
}

}  // namespace
}  // namespace adit::applier

int main(int argc, char** argv) {
  using namespace adit;
  using namespace adit::applier;
  return command_line::run<UpdateOptions>(
      command_line_of, ADIT_VERSION, argc, argv, [](const UpdateOptions& options) {
        const auto done = options.good ? watch_health(options) : Updater(options).work();
        return host::log_failure(host::Level::Error, "cannot run", done) ? 0 : 1;
      });
}
