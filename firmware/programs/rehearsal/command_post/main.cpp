// adit-rehearsal: a Command Post to rehearse against.

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "command_line/program.hpp"
#include "command_line/read.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"
#include "rehearsal/command_post/command_post.hpp"
#include "rehearsal/command_post/document.hpp"
#include "rehearsal/command_post/server.hpp"
#include "rehearsal/common.hpp"

namespace adit::rehearsal {
namespace {

using command_line::number;
using command_line::take;
using command_line::Wanted;
using command_line::Wrong;

constexpr double kMost = 1e9;

std::expected<Address, std::string> listening_address(const std::string& text) {
  auto address = read_address(text, 0);
  if (!address) return wrong("expected ADDR:PORT, got '", text, "': ", address.error());
  return address;
}

std::expected<Counted, std::string> counted_of(const std::string& text) {
  if (text == "starts") return Counted::Starts;
  if (text == "last-bytes") return Counted::LastBytes;
  if (text == "answers") return Counted::Answers;
  return std::unexpected("expected starts, last-bytes or answers, got '" + text + "'");
}

std::expected<std::vector<std::string>, std::string> roster_of(const std::string& text) {
  std::vector<std::string> roster;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string& name = roster.emplace_back(icd::cut(rest, ','));
    if (is_robot_name(name)) continue;
    return std::unexpected("expected names of 1 to 10 letters, digits and underscores, got '" + name + "'");
  }
  return roster;
}

/// The ICD's section 5 can be read so that its rate is of all API requests together.
Wrong take_rate(Options& options, const std::string& text) {
  options.one_api_limit = text == "api";
  if (options.one_api_limit) {
    options.rate = 1;
    return std::nullopt;
  }
  double rate = 0;
  auto fault = command_line::read_number(text, 0.0, kMost, rate);
  if (!fault) options.rate = rate;
  return fault;
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
            parsed_value<listening_address>(options.scoring), Wanted::Always},
           {"--mapping", "ADDR:PORT", "address of the mapping endpoint",
            parsed_value<listening_address>(options.mapping), Wanted::Always},
           {"--secrets", "DIR", "directory of the tokens: scoring.token and mapping.token", &options.secrets,
            Wanted::Always},
           {"--artifacts", "CSV", "true artifacts that reports are scored against: type,x,y,z",
            &options.artifacts},
           {"--transcript", "DIR", "record every request in this directory", &options.transcript},
           {"--transcript-mb", "N", "save no more map pictures when the transcript has N MB (2000)",
            number<0UL, UINT32_MAX>(options.transcript_megabytes)},
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
            parsed_value<counted_of>(options.counted)},
           {"--link", "MBIT",
            "limit the data received at both endpoints together to MBIT Mbit/s (0: no limit)",
            number<0.0, kMost>(options.link)},
           {"--roster", "NAME,...", "names of the registered robots; any other name is a violation",
            parsed_value<roster_of>(options.roster)},
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
            parsed_value<listening_address>(options.control)},
           {"--verbose", "", "print a line for each request even if stdout is not a terminal",
            &options.verbose}},
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
  const std::filesystem::path folder = options.secrets;
  const std::string scoring = ADIT_TRY(read_token(folder / "scoring.token"));
  const std::string mapping = ADIT_TRY(read_token(folder / "mapping.token"));
  std::vector<Artifact> artifacts;
  if (!options.artifacts.empty()) artifacts = ADIT_TRY(read_artifacts(options.artifacts));
  std::unique_ptr<Transcript> transcript;
  if (!options.transcript.empty())
    transcript = ADIT_TRY(Transcript::open(options.transcript, options.transcript_megabytes * 1'000'000));
  auto post = std::make_unique<CommandPost>(options, Secrets{scoring, mapping}, std::move(artifacts),
                                            std::move(transcript));
  ADIT_TRY(tell_faults(options, post->faults()));
  return post;
}

using Servers = std::vector<std::pair<const char*, std::unique_ptr<Server>>>;  // with their names

std::expected<Servers, std::string> listen(const Options& options, CommandPost& post) {
  Servers servers;
  const auto add = [&](const char* name, const Address& address, const WireManner& manner,
                       Decide decide) -> Told {
    auto server = Server::listen(address, manner, std::move(decide));
    if (!server) return wrong(name, ": ", server.error());
    servers.emplace_back(name, *std::move(server));
    return {};
  };
  const WireManner mapping{.answers_expect = options.manner == Manner::Strict,
                           .slash = options.slash,
                           .serial = options.serial,
                           .link = options.link > 0 ? std::make_shared<Link>(options.link) : nullptr};
  WireManner scoring = mapping;
  scoring.answers_expect = true;
  scoring.most_body = kMostSmallBody;
  ADIT_TRY(add("scoring", options.scoring, scoring, std::bind_front(&CommandPost::scoring, &post)));
  ADIT_TRY(add("mapping", options.mapping, mapping, std::bind_front(&CommandPost::mapping, &post)));
  if (options.control) {
    ADIT_TRY(add("control", *options.control, {.most_body = kMostSmallBody},
                 std::bind_front(&CommandPost::control, &post)));
  }
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
  const sigset_t signals = block_signals({SIGINT, SIGTERM, SIGUSR1});
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
