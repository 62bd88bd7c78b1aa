#include "gateway/service.hpp"

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <utility>

#include "box/lights.hpp"
#include "box/this_box.hpp"
#include "forward/clocks.hpp"
#include "host/disk.hpp"
#include "host/files.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "host/systemd.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "loop/watchdog.hpp"
#include "panel/reopened.hpp"
#include "settings/written.hpp"

namespace adit::gateway {
namespace {

/// For the process after exec: why the last change was reverted, and the rest of FileReturn in seconds.
constexpr const char *kTrouble = "ADIT_TROUBLE", *kFileRest = "ADIT_FILE_REST";

/// Reads and removes a variable of the environment.
std::string take_variable(const char* variable) {
  const char* const value = std::getenv(variable);
  std::string text = value != nullptr ? value : "";
  unsetenv(variable);
  return text;
}

/// For files that need not survive the box.
std::string runtime_folder(const Options& options) {
  const char* const runtime = std::getenv("RUNTIME_DIRECTORY");
  return runtime != nullptr ? runtime : options.state;
}

/// Renames a directory and deletes an older copy.
std::string renamed_aside(const std::string& directory) {
  const std::string aside = directory + ".aside";
  std::error_code error;
  if (!std::filesystem::exists(directory, error) && !error) return "";
  if (!error) std::filesystem::remove_all(aside, error);
  if (!error) std::filesystem::rename(directory, aside, error);
  return error ? directory + ": " + error.message() + "; " : aside + "; ";
}

/// Creates the state directory for this user alone.
std::expected<void, std::string> make_folder(const std::string& folder) {
  std::error_code error;
  if (std::filesystem::create_directories(folder, error)) {
    std::filesystem::permissions(folder, std::filesystem::perms::owner_all, error);
  }
  if (error) return std::unexpected(folder + ": " + error.message());
  return {};
}

std::string ledger_memory(const Options& options) {
  return runtime_folder(options) + '/' + ledger::Ledger::kMemory;
}

/// If the ledger is unreadable, reports are rejected, and other messages flow.
ledger::Result<ledger::Ledger> open_ledger(const Options& options) {
  using enum ledger::Error::Cause;
  const auto kept = forward::StampFloor(options.state).read();  // an error puts the box on standby
  const ledger::LedgerFacts known = kept ? kept->ledger : ledger::LedgerFacts();
  const std::string memory = ledger_memory(options);
  auto opened = ledger::Ledger::open(options.state, known, memory);
  if (!opened && opened.error().cause != InUse && opened.error().cause != Newer)
    return ledger::Ledger::make_closed(opened.error().what, known, memory);
  if (opened && !opened->damage().empty()) host::log(host::Level::Error, opened->damage());
  if (opened && !opened->warning().empty())
    host::log(host::Level::Warning, "an older copy of the ledger would not be found",
              {{"why", opened->warning()}});
  return opened;
}

int fail(const std::string& why) {
  host::log(host::Level::Error, "cannot start", {{"why", why}});
  return 1;
}

}  // namespace

Service::Service(const Options& options, char* const* arguments)
    : options_(options),
      arguments_(arguments),
      store_(options.settings, options.secrets, options.state),
      reset_(store_, options.state, runtime_folder(options)),
      takeover_(store_, options.state, ledger_memory(options)),
      trouble_(take_variable(kTrouble)),
      file_rest_(std::strtol(take_variable(kFileRest).c_str(), nullptr, 10)) {
  if (file_rest_ < FileReturn::kRest) file_rest_ = FileReturn::kRest;
}

int Service::run(int (*count_faults)(const char* file) noexcept) {
  const auto terminated = loop_.signal(SIGTERM, [this] { running_->stop(); });
  const auto interrupted = loop_.signal(SIGINT, [this] { running_->stop(); });
  // First: the lights show a failed start.
  if (!options_.panel.empty()) announced_ = panel::announce(options_.panel);
  if (auto taken = take_over_sockets(); !taken) return fail(taken.error());
  host::log_failure(host::Level::Error, "cannot create the state directory", make_folder(options_.state));
  if (const int error = count_faults(faults_file().c_str()); error != 0)
    host::log(host::Level::Error, "faults are not counted, and no queue is put aside after them",
              {{"why", host::path_error(faults_file(), error)}});
  for (const std::string& folder :
       {options_.state, options_.state + '/' + settings::kSecretsFolder, runtime_folder(options_)}) {
    host::remove_unwritten(folder);
  }
  const auto again = run_gateway();
  if (!again) {
    if (!store_.revert()) return fail(again.error());
    host::log(host::Level::Error, "the last change of the settings was reverted", {{"why", again.error()}});
    restart_process("the last change was reverted: " + again.error());
  }
  host::log(host::Level::Notice, "stopped");
  if (*again) restart_process("");
  return 0;
}

std::string Service::faults_file() const {
  return runtime_folder(options_) + "/faults";
}

/// A sentence, or "".
std::string Service::put_queue_aside() {
  std::error_code error;
  const std::uintmax_t faults = std::filesystem::file_size(faults_file(), error);
  if (error && error != std::errc::no_such_file_or_directory)
    host::log(host::Level::Warning, "cannot read how often aditd ended by a fault",
              {{"why", error.message()}});
  if (error || faults < kMostFaults) return "";
  std::string why = icd::sentence("the service ended ", faults,
                                  " times by a fault, soon after its start; queued maps, states and "
                                  "markers were put aside: ");
  for (const char* const directory : {forward::Flow::kJournal, forward::Flow::kWaiting})
    why += renamed_aside(runtime_folder(options_) + directory);
  forget_faults();
  why.resize(why.size() - 2);
  host::log(host::Level::Error, why);
  return why;
}

void Service::forget_faults() {
  std::error_code error;
  std::filesystem::resize_file(faults_file(), 0, error);
  if (error && error != std::errc::no_such_file_or_directory)
    host::log(host::Level::Warning, "cannot forget earlier faults", {{"why", error.message()}});
}

void Service::restart_process(const std::string& trouble) {
  host::restart_process(sockets_.hand_over(), arguments_,
                        {{kTrouble, trouble}, {kFileRest, std::to_string(file_rest_.count())}});
}

/// True: restart. An error: the gateway could not start.
std::expected<bool, std::string> Service::run_gateway() {
  if (const auto done = reset_.finish(); !done) {
    trouble_ = "the factory reset is incomplete: " + done.error();
    host::log(host::Level::Error, trouble_);
  }
  std::string put_aside = put_queue_aside();
  std::string stuck = finish_takeover();
  host::keep_out_of_log(store_.redaction());
  auto loaded = ADIT_TRY(store_.load());
  auto ledger = open_ledger(options_);
  if (!ledger) return std::unexpected(ledger.error().what);
  auto wear = host::read_wear(options_.state, options_.block);
  if (!wear) host::log(host::Level::Warning, "the disk's health is unknown", {{"why", wear.error()}});
  auto known = box::read_board(options_.board);
  const std::string runtime = runtime_folder(options_);
  auto panel = box::open_panel(known.board.panel.value_or(loaded.settings.panel),
                               {.socket = options_.panel, .folder = runtime}, std::exchange(announced_, {}));
  const settings::Settings settings = loaded.settings;
  Gateway gateway(loop_, {.options = options_,
                          .store = store_,
                          .reset = reset_,
                          .takeover = takeover_,
                          .sockets = sockets_,
                          .loaded = std::move(loaded),
                          .trouble = trouble_,
                          .put_aside = std::move(put_aside),
                          .stuck = std::move(stuck),
                          .ledger = std::move(*ledger),
                          .wear = std::move(wear),
                          .file_rest = file_rest_,
                          .board = std::move(known.board),
                          .board_trouble = std::move(known.trouble),
                          .lines = std::move(panel.lines),
                          .button = std::move(panel.button),
                          .runtime_folder = runtime});
  return run(gateway, settings);
}

/// Why it is unfinished, or "".
std::string Service::finish_takeover() {
  const auto done = takeover_.finish(loop_);
  if (done) return "";
  host::log(host::Level::Error, "the take-over is incomplete", {{"why", done.error()}});
  return "the take-over is not finished: " + done.error();
}

std::expected<bool, std::string> Service::run(Gateway& gateway, const settings::Settings& settings) {
  ADIT_TRY(gateway.start());
  store_.settle(settings);
  sockets_.settle();
  host::notify_ready(gateway.status_line());
  std::optional<loop::Watchdog> watchdog;
  if (const auto within = host::watchdog_interval()) {
    watchdog.emplace(loop_, *within, &host::notify_alive);
    watchdog->watch_workers(gateway.threads());
  }
  running_ = &gateway;
  file_rest_ = gateway.awaits_files() ? longer(file_rest_) : FileReturn::kRest;
  loop::Source well = loop_.timer([this] { forget_faults(); });
  well.call_at(loop_.now() + kWell);
  loop_.run();
  forget_faults();
  if (gateway.makes_way()) host::notify_restarting();
  return gateway.makes_way();
}

std::expected<void, std::string> Service::take_over_sockets() {
  auto given = ADIT_TRY(host::inherited_sockets());
  auto sockets = ADIT_TRY(ListenSockets::take_over(std::move(given)));
  sockets_ = std::move(sockets);
  return {};
}

}  // namespace adit::gateway
