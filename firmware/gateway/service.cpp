#include "gateway/service.hpp"

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "box/open_panel.hpp"
#include "host/inherited.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "panel/remote.hpp"
#include "settings/saved.hpp"

namespace adit::gateway {
namespace {

/// Where what need not outlive the box is kept.
std::string runtime_folder(const Options& options) {
  const char* const runtime = std::getenv("RUNTIME_DIRECTORY");
  return runtime != nullptr ? runtime : options.state;
}

/// The state folder, made where it is not there yet, for this user alone.
std::expected<void, std::string> make_folder(const std::string& folder) {
  std::error_code error;
  if (std::filesystem::create_directories(folder, error)) {
    std::filesystem::permissions(folder, std::filesystem::perms::owner_all, error);
  }
  if (error) return std::unexpected(folder + ": " + error.message());
  return {};
}

/// Where the state folder is full, cannot be written to, or fails, maps and states flow all the same; reports
/// are refused, and those that can be read are shown.
ledger::Result<ledger::Ledger> open_ledger(const Options& options) {
  using ledger::Ledger;
  std::error_code unknown;
  const char* const runtime = std::getenv("RUNTIME_DIRECTORY");
  const std::string scratch = runtime != nullptr ? runtime : std::filesystem::temp_directory_path(unknown);
  Ledger::sweep(options.state, scratch);
  auto opened = Ledger::open(options.state);
  const bool is_there = std::filesystem::exists(options.state, unknown);
  const auto is_the_disk = [](const ledger::Error& error) {
    using enum ledger::Error::Kind;
    return error.kind == Full || error.kind == ReadOnly || error.kind == Failing;
  };
  if (!opened && (is_the_disk(opened.error()) || !is_there)) {
    host::log(host::Level::Error, "rejecting reports: the ledger cannot be written",
              {{"why", opened.error().what}});
    opened = Ledger::stand_in(options.state, scratch, opened.error().what);
  }
  if (opened && !opened->damage().empty()) host::log(host::Level::Error, opened->damage());
  return opened;
}

std::expected<Parts, std::string> gather(const Options& options, admin::Store& store,
                                         admin::FactoryReset& reset, admin::TakingOver& taking_over,
                                         ListenSockets& sockets, loop::FileDescriptor announced) {
  host::keep_out_of_log(store.redaction());
  auto loaded = store.load();
  if (!loaded) return std::unexpected(loaded.error());
  auto ledger = open_ledger(options);
  if (!ledger) return std::unexpected(ledger.error().what);
  auto known = box::read_board(options.board);
  auto panel =
      box::open_panel(known.board.panel.value_or(loaded->settings.panel),
                      {.socket = options.panel, .folder = runtime_folder(options)}, std::move(announced));
  return Parts{.store = store,
               .reset = reset,
               .taking_over = taking_over,
               .sockets = sockets,
               .loaded = std::move(*loaded),
               .trouble = "",
               .take_over_trouble = "",
               .ledger = std::move(*ledger),
               .ledger_rest = LedgerReturn::kRest,
               .board = std::move(known.board),
               .board_trouble = std::move(known.trouble),
               .lines = std::move(panel.lines),
               .button = std::move(panel.button),
               .panel_socket = options.panel,
               .runtime_folder = runtime_folder(options),
               .state_folder = options.state,
               .update_folder = options.update,
               .network_folder = options.network,
               .watch_folder = options.watch,
               .clock_folder = options.clock,
               .spare_folder = options.spare,
               .notices_folder = options.notices,
               .legacy = std::nullopt};
}

int fail(const std::string& why) {
  host::log(host::Level::Error, "cannot start", {{"why", why}});
  return 1;
}

}  // namespace

Service::Service(const Options& options)
    : options_(options),
      store_(options.settings, options.secrets, options.state),
      reset_(store_, options.state, runtime_folder(options)),
      taking_over_(store_, options.state, runtime_folder(options)) {}

int Service::run() {
  const auto terminated = loop_.signal(SIGTERM, [this] { running_->stop(); });
  const auto interrupted = loop_.signal(SIGINT, [this] { running_->stop(); });
  announce();
  if (auto taken = take_over_sockets(); !taken) return fail(taken.error());
  if (auto made = make_folder(options_.state); !made) {
    host::log(host::Level::Error, "cannot create the state directory", {{"why", made.error()}});
  }
  for (const std::string& folder :
       {options_.state, options_.state + '/' + settings::kSecretsFolder, runtime_folder(options_)}) {
    host::remove_unwritten(folder);
  }
  while (true) {
    const auto again = run_one();
    if (again && !*again) break;
    trouble_.clear();
    if (again) continue;
    if (!store_.revert()) return fail(again.error());
    trouble_ = "the last change was reverted: " + again.error();
    host::log(host::Level::Error, "the last change of the settings was reverted", {{"why", again.error()}});
  }
  host::log(host::Level::Notice, "stopped");
  return 0;
}

/// First of all: a start that comes to nothing shows on the lights.
void Service::announce() {
  if (!announced_ && !options_.panel.empty()) announced_ = panel::announce(options_.panel);
}

/// Whether another is to follow; an error: it could not start.
std::expected<bool, std::string> Service::run_one() {
  announce();
  if (const auto done = reset_.finish(); !done) {
    trouble_ = "the factory reset is incomplete: " + done.error();
    host::log(host::Level::Error, trouble_);
  } else if (*done) {
    legacy_.reset();  // the team's before: its map, its robots
  }
  const std::string take_over_trouble = finish_taking_over();
  auto parts = gather(options_, store_, reset_, taking_over_, sockets_, std::exchange(announced_, {}));
  if (!parts) return std::unexpected(parts.error());
  parts->take_over_trouble = take_over_trouble;
  const settings::Settings settings = parts->loaded.settings;
  parts->trouble = trouble_;
  const bool waits_for_ledger = !parts->ledger.refusal().empty();
  parts->ledger_rest =
      std::exchange(ledger_rest_, waits_for_ledger ? longer(ledger_rest_) : LedgerReturn::kRest);
  parts->legacy = std::exchange(legacy_, std::nullopt);
  Gateway gateway(loop_, std::move(*parts));
  const auto ran = run(gateway, settings);
  legacy_ = gateway.hand_over();
  return ran;
}

/// Why it is not finished, or "".
std::string Service::finish_taking_over() {
  const auto done = taking_over_.finish(loop_);
  if (!done) {
    host::log(host::Level::Error, "the take-over is incomplete", {{"why", done.error()}});
    return done.error();
  }
  if (*done) legacy_.reset();  // of this box, which goes on as another
  return "";
}

std::expected<bool, std::string> Service::run(Gateway& gateway, const settings::Settings& settings) {
  if (const auto started = gateway.start(); !started) return std::unexpected(started.error());
  store_.settle(settings);
  sockets_.settle();
  host::notify_ready(gateway.status_line());
  begin_watchdog();
  if (watchdog_) watchdog_->ask_also(gateway.threads());
  running_ = &gateway;
  loop_.run();
  if (watchdog_) watchdog_->ask_also({});
  return gateway.makes_way();
}

void Service::begin_watchdog() {
  if (watchdog_) return;
  if (const auto within = host::watchdog_within()) {
    watchdog_.emplace(loop_, *within, &host::notify_alive);
  }
}

std::expected<void, std::string> Service::take_over_sockets() {
  auto given = host::inherited();
  if (!given) return std::unexpected(std::move(given.error()));
  auto sockets = ListenSockets::take_over(std::move(*given));
  if (!sockets) return std::unexpected(std::move(sockets.error()));
  sockets_ = std::move(*sockets);
  return {};
}

}  // namespace adit::gateway
