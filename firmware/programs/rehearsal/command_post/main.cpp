// adit-rehearsal: a Command Post to rehearse against.

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "command_line/read.hpp"
#include "rehearsal/command_post/command_post.hpp"
#include "rehearsal/command_post/options.hpp"
#include "rehearsal/command_post/server.hpp"

namespace adit::rehearsal {
namespace {

constexpr int kWrongUse = 2;
constexpr std::size_t kMostSmallBody = std::size_t{1} << 20;  // of scoring and control
constexpr int kKilled = 3;  // the mapping server as measured died of a message

int complain(const std::string& why) {
  std::fprintf(stderr, "adit-rehearsal: %s\n", why.c_str());
  return kWrongUse;
}

Told tell_faults(const Options& options, Faults& faults) {
  for (const std::string& text : options.faults) {
    if (auto told = faults.tell(text); !told) return std::unexpected("--fault: " + told.error());
  }
  for (const std::string& text : options.fault_rates) {
    if (auto told = faults.tell_rate(text); !told) return std::unexpected("--fault-rate: " + told.error());
  }
  return {};
}

std::expected<std::unique_ptr<CommandPost>, std::string> build(const Options& options) {
  const auto secrets = read_secrets(options.secrets);
  if (!secrets) return std::unexpected(secrets.error());
  std::vector<Artifact> artifacts;
  if (!options.artifacts.empty()) {
    auto read = read_artifacts(options.artifacts);
    if (!read) return std::unexpected(read.error());
    artifacts = std::move(*read);
  }
  std::unique_ptr<Transcript> transcript;
  if (!options.transcript.empty()) {
    auto opened = Transcript::open(options.transcript, options.transcript_bytes);
    if (!opened) return std::unexpected(opened.error());
    transcript = std::move(*opened);
  }
  auto post = std::make_unique<CommandPost>(options, *secrets, std::move(artifacts), std::move(transcript));
  if (auto told = tell_faults(options, post->faults()); !told) return std::unexpected(told.error());
  return post;
}

/// The signals that main waits for; blocked before the first thread starts.
sigset_t awaited_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

void print(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  (void)std::fflush(stdout);
}

using Servers = std::vector<std::pair<const char*, std::unique_ptr<Server>>>;  // with their names

std::expected<Servers, std::string> listen(const Options& options, CommandPost& post) {
  Servers servers;
  std::string wrong;
  const auto add = [&](const char* name, const Address& address, const WireManner& manner, Decide decide) {
    auto server = Server::listen(address, manner, std::move(decide));
    if (server) servers.emplace_back(name, std::move(*server));
    if (!server && wrong.empty()) wrong = std::string(name) + ": " + server.error();
  };
  const WireManner mapping{.answers_expect = options.manner == Manner::Strict,
                           .slash = options.slash,
                           .serial = options.serial,
                           .link = options.link > 0 ? std::make_shared<Link>(options.link) : nullptr};
  WireManner scoring = mapping;
  scoring.answers_expect = true;
  scoring.most_body = kMostSmallBody;
  add("scoring", options.scoring, scoring, [&post](const Request& request) { return post.scoring(request); });
  add("mapping", options.mapping, mapping, [&post](const Request& request) { return post.mapping(request); });
  if (options.control) {
    add("control", *options.control, {.most_body = kMostSmallBody},
        [&post](const Request& request) { return post.control(request); });
  }
  if (!wrong.empty()) return std::unexpected(wrong);
  return servers;
}

std::string first_line(const Servers& servers) {
  std::string line = "adit-rehearsal:";
  for (const auto& [name, server] : servers)
    line.append(" ").append(name).append(" ").append(server->address().text());
  return line + "\n";
}

/// Whoever is in the middle of a large map has this long; then the process ends all the same.
bool stop_all(const Servers& servers) {
  constexpr std::chrono::milliseconds patience{250};
  for (const auto& [name, server] : servers) server->stop();
  bool drained = true;
  for (const auto& [name, server] : servers) drained = server->drained(patience) && drained;
  return drained;
}

int run(const Options& options) {
  const sigset_t signals = awaited_signals();
  auto post = build(options);
  if (!post) return complain(post.error());
  const auto servers = listen(options, **post);
  if (!servers) return complain(servers.error());
  print(first_line(*servers));
  for (int signal = SIGUSR1; signal == SIGUSR1;) {
    if (sigwait(&signals, &signal) != 0) break;
    if (signal == SIGUSR1) print((*post)->summary());
  }
  const bool drained = stop_all(*servers);
  print((*post)->summary());
  const int code = (*post)->killed_by().empty() ? EXIT_SUCCESS : kKilled;
  if (!drained) std::_Exit(code);  // a thread still works on what they share
  return code;
}

/// The script that is installed beside this program, in its place, with the programs in this one's folder:
/// arguments[0] is "demo".
int demo(char** arguments) {
  std::error_code error;
  const auto folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  const std::string script = folder.parent_path() / "lib/adit-rehearsal/demo";
  if (::setenv("ADIT_BIN", folder.c_str(), 1) == 0) ::execv(script.c_str(), arguments);
  return complain(script + ": " + std::strerror(errno));
}

}  // namespace
}  // namespace adit::rehearsal

int main(int count, char** arguments) {
  using namespace adit::rehearsal;
  if (count > 1 && std::string_view(arguments[1]) == "demo") return demo(arguments + 1);
  auto options = adit::command_line::read(command_line_of, {arguments + 1, arguments + count});
  if (const auto exit = adit::command_line::answer(command_line_of, ADIT_VERSION, options)) return *exit;
  options->verbose = options->verbose || ::isatty(STDOUT_FILENO) == 1;
  return run(*options);
}
