/// aditd: the only place that knows all rooms.

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <utility>

#include "gateway/gateway.hpp"
#include "gateway/notices.hpp"
#include "gateway/open_panel.hpp"
#include "gateway/options.hpp"
#include "gateway/version.hpp"
#include "host/command_line.hpp"
#include "host/inherited.hpp"
#include "host/log.hpp"
#include "loop/guard.hpp"
#include "loop/watchdog.hpp"

namespace {

using adit::gateway::FactoryReset;
using adit::gateway::Gateway;
using adit::gateway::LedgerReturn;
using adit::gateway::ListenSockets;
using adit::gateway::Options;
using adit::gateway::Parts;
using adit::gateway::Store;

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

/// Where the state folder is full, or cannot be written to, maps and states flow all the same; reports are
/// refused, and those that can be read are shown.
adit::ledger::Result<adit::ledger::Ledger> open_ledger(const Options& options) {
  using adit::ledger::Ledger;
  std::error_code unknown;
  const char* const runtime = std::getenv("RUNTIME_DIRECTORY");
  const std::string scratch = runtime != nullptr ? runtime : std::filesystem::temp_directory_path(unknown);
  Ledger::sweep(options.state, scratch);
  auto opened = Ledger::open(options.state);
  const bool is_there = std::filesystem::exists(options.state, unknown);
  if (!opened && (opened.error().full || opened.error().read_only || !is_there)) {
    adit::host::log(adit::host::Level::Error, "no report is taken, the ledger cannot be written",
                    {{"why", opened.error().what}});
    opened = Ledger::stand_in(options.state, scratch, opened.error().what);
  }
  if (opened && !opened->damage().empty()) adit::host::log(adit::host::Level::Error, opened->damage());
  return opened;
}

std::expected<Parts, std::string> gather(const Options& options, const Store& store,
                                         const FactoryReset& reset, ListenSockets& sockets) {
  auto loaded = store.load();
  if (!loaded) return std::unexpected(loaded.error());
  auto ledger = open_ledger(options);
  if (!ledger) return std::unexpected(ledger.error().what);
  auto known = adit::gateway::read_board(options.board);
  auto panel =
      adit::gateway::open_panel(known.board.panel.value_or(loaded->settings.panel), runtime_folder(options));
  return Parts{.store = store,
               .reset = reset,
               .sockets = sockets,
               .loaded = std::move(*loaded),
               .trouble = "",
               .ledger = std::move(*ledger),
               .ledger_rest = LedgerReturn::kRest,
               .board = std::move(known.board),
               .board_trouble = std::move(known.trouble),
               .notices = adit::gateway::read_notices(options.notices),
               .lines = std::move(panel.lines),
               .button = std::move(panel.button),
               .runtime_folder = runtime_folder(options),
               .state_folder = options.state,
               .update_folder = options.update,
               .network_folder = options.network,
               .legacy = std::nullopt};
}

int fail(const std::string& why) {
  adit::host::log(adit::host::Level::Error, "cannot start", {{"why", why}});
  return 1;
}

/// Gateways, one after the other on one loop: each runs until it is stopped, or makes way for one of changed
/// settings.
class Service {
 public:
  explicit Service(const Options& options)
      : options_(options),
        store_(options.settings, options.secrets, options.state),
        reset_(store_, options.state, runtime_folder(options)) {}

  int run() {
    if (auto taken = take_over_sockets(); !taken) return fail(taken.error());
    if (auto made = make_folder(options_.state); !made) {
      adit::host::log(adit::host::Level::Error, "the state folder cannot be made", {{"why", made.error()}});
    }
    const auto terminated = loop_.signal(SIGTERM, [this] { running_->stop(); });
    const auto interrupted = loop_.signal(SIGINT, [this] { running_->stop(); });
    while (true) {
      const auto anew = run_one();
      if (anew && !*anew) break;
      trouble_.clear();
      if (anew) continue;
      if (!store_.take_back()) return fail(anew.error());
      trouble_ = "the last change was taken back: " + anew.error();
      adit::host::log(adit::host::Level::Error, "the last change of the settings is taken back",
                      {{"why", anew.error()}});
    }
    adit::host::log(adit::host::Level::Notice, "stopped");
    return 0;
  }

 private:
  /// Whether another is to follow; an error: it could not start.
  std::expected<bool, std::string> run_one() {
    if (const auto done = reset_.finish(); !done) {
      trouble_ = "the factory reset is not finished: " + done.error();
      adit::host::log(adit::host::Level::Error, trouble_);
    } else if (*done) {
      legacy_.reset();  // the team's before: its map, its robots
    }
    auto parts = gather(options_, store_, reset_, sockets_);
    if (!parts) return std::unexpected(parts.error());
    const adit::settings::Settings settings = parts->loaded.settings;
    parts->trouble = trouble_;
    const bool waits_for_ledger = !parts->ledger.refusal().empty();
    parts->ledger_rest = std::exchange(
        ledger_rest_, waits_for_ledger ? adit::gateway::longer(ledger_rest_) : LedgerReturn::kRest);
    parts->legacy = std::exchange(legacy_, std::nullopt);
    Gateway gateway(loop_, std::move(*parts));
    const auto ran = run(gateway, settings);
    legacy_ = gateway.hand_over();
    return ran;
  }

  std::expected<bool, std::string> run(Gateway& gateway, const adit::settings::Settings& settings) {
    if (const auto started = gateway.start(); !started) return std::unexpected(started.error());
    store_.settle(settings);
    sockets_.settle();
    adit::host::notify_ready(gateway.status_line());
    begin_watchdog();
    if (watchdog_) watchdog_->ask_also(gateway.threads());
    running_ = &gateway;
    loop_.run();
    if (watchdog_) watchdog_->ask_also({});
    return gateway.makes_way();
  }

  void begin_watchdog() {
    if (watchdog_) return;
    if (const auto within = adit::host::watchdog_within()) {
      watchdog_.emplace(loop_, *within, &adit::host::notify_alive);
    }
  }

  std::expected<void, std::string> take_over_sockets() {
    auto given = adit::host::inherited();
    if (!given) return std::unexpected(std::move(given.error()));
    auto sockets = ListenSockets::take_over(std::move(*given));
    if (!sockets) return std::unexpected(std::move(sockets.error()));
    sockets_ = std::move(*sockets);
    return {};
  }

  const Options& options_;
  Store store_;
  FactoryReset reset_;
  ListenSockets sockets_;
  adit::loop::Loop loop_;
  std::optional<adit::loop::Watchdog> watchdog_;  // where systemd wants one
  Gateway* running_ = nullptr;                    // signals come while the loop runs, and so does it
  std::string trouble_;                           // what came of the last change
  std::optional<adit::gateway::Legacy> legacy_;
  std::chrono::seconds ledger_rest_ = LedgerReturn::kRest;
};

}  // namespace

int main(int argc, char** argv) {
  const auto options =
      adit::gateway::parse_options(std::span<char* const>(argv + 1, static_cast<std::size_t>(argc - 1)));
  if (const auto exit =
          adit::host::answered("aditd", adit::gateway::kVersion, adit::gateway::kUsage, options))
    return *exit;
  adit::loop::tell_of_caught([](const char* where, const char* what) {
    adit::host::log(adit::host::Level::Error, "an exception ended what it came from",
                    {{"what", where}, {"why", what}});
  });
  int exit = 1;
  adit::loop::guarded("the service", [&] { exit = Service(*options).run(); });
  return exit;
}
