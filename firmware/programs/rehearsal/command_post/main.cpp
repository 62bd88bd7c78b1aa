#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "command_line/program.hpp"
#include "command_line/read.hpp"
#include "rehearsal/command_post/command_post.hpp"
#include "rehearsal/command_post/fields.hpp"
#include "rehearsal/command_post/server.hpp"

namespace adit::rehearsal {
namespace {

using command_line::number;
using command_line::take;
using command_line::Wanted;
using command_line::Wrong;

constexpr double kMost = 1e9;

/// Into an Address, or an optional one.
template <class Into>
Wrong take_address(Into& into, const std::string& text) {
  const auto colon = text.rfind(':');
  Address address{.host = text.substr(0, colon)};
  if (address.host.starts_with('[') && address.host.ends_with(']'))
    address.host = address.host.substr(1, address.host.size() - 2);
  if (colon == std::string::npos || address.host.empty()) return "expected ADDR:PORT, got '" + text + "'";
  std::uint64_t port = 0;
  auto wrong = command_line::read_number(text.substr(colon + 1), 0, UINT16_MAX, port);
  address.port = static_cast<std::uint16_t>(port);
  if (!wrong) into = std::move(address);
  return wrong;
}

Wrong take_megabytes(std::uint64_t& bytes, const std::string& text) {
  auto wrong = command_line::read_number(text, 0, UINT32_MAX, bytes);
  bytes *= 1'000'000;
  return wrong;
}

Wrong take_counted(std::optional<Counted>& counted, const std::string& text) {
  static const std::map<std::string, Counted> kWords = {
      {"starts", Counted::Starts}, {"last-bytes", Counted::LastBytes}, {"answers", Counted::Answers}};
  const auto found = kWords.find(text);
  if (found == kWords.end()) return "expected starts, last-bytes or answers, got '" + text + "'";
  counted = found->second;
  return std::nullopt;
}

Wrong take_roster(std::vector<std::string>& roster, const std::string& text) {
  std::istringstream names(text);
  for (std::string name; std::getline(names, name, ',');) {
    if (!is_robot_name(name))
      return "expected names of 1 to 10 letters, digits and underscores, got '" + name + "'";
    roster.push_back(name);
  }
  return std::nullopt;
}

/// The ICD's section 5 can be read so that its rate is of all API requests together.
Wrong take_rate(Options& options, const std::string& text) {
  options.one_api_limit = text == "api";
  if (options.one_api_limit) {
    options.rate = 1;
    return std::nullopt;
  }
  double rate = 0;
  auto wrong = command_line::read_number(text, 0.0, kMost, rate);
  if (!wrong) options.rate = rate;
  return wrong;
}

Wrong take_as_measured(Options& options, const std::string&) {
  options.manner = Manner::AsMeasured;
  options.run.renames = false;
  return std::nullopt;
}

[[gnu::cold]] command_line::Program command_line_of(Options& options) {
  return {
      .name = "adit-rehearsal",
      .usage = "",
      .about = "Simulated Command Post for rehearsals.",
      .rows =
          {{"--scoring", "ADDR:PORT", "address of the scoring endpoint (port 0: any free port)",
            take<take_address<Address>>(options.scoring), Wanted::Always},
           {"--mapping", "ADDR:PORT", "address of the mapping endpoint",
            take<take_address<Address>>(options.mapping), Wanted::Always},
           {"--secrets", "DIR", "directory of the tokens: scoring.token and mapping.token", &options.secrets,
            Wanted::Always},
           {"--artifacts", "CSV", "true artifacts that reports are scored against: type,x,y,z",
            &options.artifacts},
           {"--transcript", "DIR", "record every request in this directory", &options.transcript},
           {"--transcript-mb", "N", "save no more map pictures when the transcript has N MB (2000)",
            take<take_megabytes>(options.transcript_bytes)},
           {"--as-measured", "", "behave like the public test servers instead of the ICD",
            take<take_as_measured>(options)},
           {"--slash", "", "redirect a path without a trailing slash to the path with one", &options.slash},
           {"--serial", "", "serve one connection of each endpoint at a time, until it is closed",
            &options.serial},
           {"--limit-bytes", "N", "answer a larger body with 413 and a page, as a proxy does (0: no limit)",
            number<0UL, UINT64_MAX>(options.limit_bytes)},
           {"--team", "NAME", "name of the team", &options.run.team},
           {"--run", "ID", "name of the run", &options.run.id},
           {"--duration", "SECONDS", "length of the run (3600)", number<0.0, kMost>(options.run.length)},
           {"--reports", "N", "number of artifact reports that the run allows (45)",
            number<0L, INT64_MAX>(options.run.reports)},
           {"--rate", "HZ|api",
            "answer 429 above this rate, for each URI (1; 0: no limit); api: 1 Hz, with one limit for "
            "statuses and reports together",
            take<take_rate>(options)},
           {"--counts", "WHAT",
            "starts, last-bytes or answers: where --rate measures the interval between two maps, states or "
            "markers messages",
            take<take_counted>(options.counted)},
           {"--link", "MBIT",
            "limit the data received at both endpoints together to MBIT Mbit/s (0: no limit)",
            number<0.0, kMost>(options.link)},
           {"--roster", "NAME,...", "names of the registered robots; any other name is a violation",
            take<take_roster>(options.roster)},
           {"--not-started", "", "start the run only on POST /start at the control port",
            &options.not_started},
           {"--fault", "AIM:FAULT", "apply FAULT to the next request of AIM; may be given several times",
            &options.faults},
           {"--fault-rate", "AIM:FAULT=RATE",
            "apply FAULT at random to this share (0 to 1) of the requests of AIM; may be given several times",
            &options.fault_rates},
           {"--seed", "N", "seed of the random faults (1)", number<0UL, UINT64_MAX>(options.seed)},
           {"--control", "ADDR:PORT",
            "address of the control port: POST /start /stop /resume /end /new-run /grant /rename "
            "/other-sender /posted, GET /record /arrivals, GET, POST and DELETE /faults",
            take<take_address<std::optional<Address>>>(options.control)},
           {"--verbose", "", "print a line for each request even if stdout is not a terminal",
            &options.verbose},
           {"--version", "", "print the version", &options.version},
           {"--help", "", "print this help", &options.help}},
      .ending =
          "If installed, adit-rehearsal demo starts this program, Adit and robots and prints the address of "
          "the page. See adit-rehearsal demo --help.\n"
          "AIM: reports, status or mapping. clock:constant stops the run's clocks in all later answers; "
          "clock:running starts them again.\n"
          "FAULT: ok, or one or more of these, separated by commas:\n"
          "  drop, reset-unrecorded, 401, 429[=COUNT], 500     not recorded\n"
          "  html-200, html-302, html-400, html-422            not recorded; a page of HTML\n"
          "  repeat-answer                                     not recorded; the previous answer again\n"
          "  record-then-drop, reset, half-answer, garbage, 500-recorded\n"
          "                                                    recorded; the answer is lost\n"
          "  length-huge, chunk-huge, header-flood, 1xx-flood, endless-body, json-deep\n"
          "                                                    recorded; an answer too long or too deep\n"
          "  record-after=SECONDS, answer-after=SECONDS        recorded or answered late\n"
          "  other-sender                                      another sender's report is recorded first\n"
          "  remaining=+N, remaining=-N                        remaining_reports is wrong by N from then on\n"
          "  retry-after=SECONDS                               the answer has this header\n"
          "  for=SECONDS                                       all requests of AIM for this long\n"
          "  robot=NAME                                        only messages that contain this name",
  };
}

std::expected<std::string, std::string> read_token(const std::string& path) {
  std::ifstream file(path);
  if (!file) return std::unexpected(path + ": cannot be read");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::string token(trimmed(text));
  const bool visible = std::ranges::all_of(token, [](char c) { return c > 0x20 && c < 0x7f; });
  if (token.empty() || !visible)
    return std::unexpected(path + ": expected one token of visible ASCII characters");
  return token;
}

/// `scoring.token` and `mapping.token` in `folder`; white space around a token is cut. An error names the
/// file, never its content.
std::expected<Secrets, std::string> read_secrets(const std::string& folder) {
  auto scoring = read_token(folder + "/scoring.token");
  if (!scoring) return std::unexpected(scoring.error());
  auto mapping = read_token(folder + "/mapping.token");
  if (!mapping) return std::unexpected(mapping.error());
  return Secrets{std::move(*scoring), std::move(*mapping)};
}

// adit-rehearsal: a Command Post to rehearse against.

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
