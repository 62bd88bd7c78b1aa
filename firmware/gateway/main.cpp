/// aditd: the only place that knows all rooms.

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <span>

#include "gateway/gateway.hpp"
#include "gateway/options.hpp"
#include "gateway/version.hpp"
#include "host/log.hpp"

namespace {

using adit::gateway::Gateway;
using adit::gateway::Options;
using adit::gateway::Parts;

/// Where what need not outlive the box is kept.
std::string runtime_folder(const Options& options) {
  const char* const runtime = std::getenv("RUNTIME_DIRECTORY");
  return runtime != nullptr ? runtime : options.state;
}

std::expected<adit::settings::Settings, std::string> read_settings(const std::string& file) {
  const auto text = adit::host::read_file(file);
  if (!text) return std::unexpected(text.error());
  auto settings = adit::settings::parse(*text);
  if (settings) return std::move(*settings);
  std::string sentences;
  for (const auto& error : settings.error()) sentences += (sentences.empty() ? "" : "; ") + error.sentence();
  return std::unexpected(file + ": " + sentences);
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

std::unique_ptr<adit::panel::Lines> open_panel(const adit::settings::Panel& settings,
                                               const std::string& folder) {
  if (!settings.chip.empty()) {
    auto lines = adit::panel::open_gpio(settings);
    if (lines) return std::move(*lines);
    adit::host::log(adit::host::Level::Error, "the panel is simulated: its lines cannot be had",
                    {{"why", lines.error()}});
  }
  return adit::panel::simulated(folder + "/panel");
}

std::expected<Parts, std::string> gather(const Options& options) {
  auto settings = read_settings(options.settings);
  if (!settings) return std::unexpected(settings.error());
  auto secrets = adit::host::read_secrets(options.secrets);
  if (!secrets) return std::unexpected(secrets.error());
  if (auto made = make_folder(options.state); !made) return std::unexpected(made.error());
  auto ledger = adit::ledger::Ledger::open(options.state);
  if (!ledger) return std::unexpected(ledger.error().what);
  auto lines = open_panel(settings->panel, runtime_folder(options));
  return Parts{.settings = std::move(*settings),
               .secrets = std::move(*secrets),
               .ledger = std::move(*ledger),
               .lines = std::move(lines),
               .spool_folder = runtime_folder(options) + "/waiting",
               .state_folder = options.state,
               .network_folder = options.network};
}

int fail(const std::string& why) {
  adit::host::log(adit::host::Level::Error, "cannot start", {{"why", why}});
  return 1;
}

int run(const Options& options) {
  auto parts = gather(options);
  if (!parts) return fail(parts.error());
  adit::loop::Loop loop;
  Gateway* running = nullptr;
  const auto stop = [&running] {
    if (running != nullptr) running->stop();
  };
  const auto terminated = loop.signal(SIGTERM, stop);
  const auto interrupted = loop.signal(SIGINT, stop);
  Gateway gateway(loop, std::move(*parts));
  running = &gateway;
  if (const auto started = gateway.start(); !started) return fail(started.error());
  loop.feed_watchdog();
  adit::host::notify_ready(gateway.status_line());
  loop.run();
  adit::host::log(adit::host::Level::Notice, "stopped");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const auto options =
      adit::gateway::parse_options(std::span<char* const>(argv + 1, static_cast<std::size_t>(argc - 1)));
  if (!options) {
    std::fprintf(stderr, "aditd: %s\n%s", options.error().c_str(), adit::gateway::kUsage);
    return 2;
  }
  if (options->help) return std::fputs(adit::gateway::kUsage, stdout) < 0 ? 1 : 0;
  if (options->version) return std::printf("aditd %s\n", adit::gateway::kVersion) < 0 ? 1 : 0;
  return run(*options);
}
