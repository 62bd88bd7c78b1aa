#include "rehearsal/command_post/options.hpp"

#include <sstream>

#include "command_line/number.hpp"
#include "rehearsal/command_post/fields.hpp"

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
  bytes <<= 20;
  return wrong;
}

Wrong take_counted(std::optional<Counted>& counted, const std::string& text) {
  if (text == "starts") {
    counted = Counted::Starts;
  } else if (text == "last-bytes") {
    counted = Counted::LastBytes;
  } else if (text == "answers") {
    counted = Counted::Answers;
  } else {
    return "expected starts, last-bytes or answers, got '" + text + "'";
  }
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

}  // namespace

command_line::Program command_line_of(Options& options) {
  return {
      .name = "adit-rehearsal",
      .usage = "",
      .about = "A Command Post to rehearse against.",
      .rows =
          {{"--scoring", "ADDR:PORT", "scoring endpoint (port 0: any)",
            take<take_address<Address>>(options.scoring), Wanted::Always},
           {"--mapping", "ADDR:PORT", "mapping endpoint", take<take_address<Address>>(options.mapping),
            Wanted::Always},
           {"--secrets", "DIR", "scoring.token and mapping.token", &options.secrets, Wanted::Always},
           {"--artifacts", "CSV", "true artifacts: type,x,y,z", &options.artifacts},
           {"--transcript", "DIR", "write down all that comes in", &options.transcript},
           {"--transcript-mb", "N", "then no more pictures of maps, only lines (2048)",
            take<take_megabytes>(options.transcript_bytes)},
           {"--as-measured", "", "behave as the public test servers do, not as the ICD says",
            take<take_as_measured>(options)},
           {"--slash", "", "redirect each path without a slash at its end to the one with it",
            &options.slash},
           {"--team", "NAME", "the team's name", &options.run.team},
           {"--run", "ID", "the run's name", &options.run.id},
           {"--duration", "SECONDS", "length of the run (3600)", number<0.0, kMost>(options.run.length)},
           {"--reports", "N", "allotment of artifact reports (45)",
            number<0L, INT64_MAX>(options.run.reports)},
           {"--rate", "HZ|api",
            "429 above it, for each URI (1; 0: no limit); api: 1 for each, and one for statuses and reports "
            "together",
            take<take_rate>(options)},
           {"--counts", "WHAT",
            "starts, last-bytes or answers (to the next start): what is counted for that rate, of maps, "
            "states and markers",
            take<take_counted>(options.counted)},
           {"--link", "MBIT", "a second, that come in over both endpoints together (0: no limit)",
            number<0.0, kMost>(options.link)},
           {"--roster", "NAME,...", "of the robots that are registered; any other name is a violation",
            take<take_roster>(options.roster)},
           {"--not-started", "", "the run waits for POST /start on the control port", &options.not_started},
           {"--fault", "AIM:FAULT", "what goes wrong with the next request of an aim; may be given often",
            &options.faults},
           {"--fault-rate", "AIM:FAULT=RATE", "what goes wrong with that part of them (0 to 1), at random",
            &options.fault_rates},
           {"--seed", "N", "of that randomness (1)", number<0UL, UINT64_MAX>(options.seed)},
           {"--control", "ADDR:PORT",
            "POST /start /stop /resume /end /new-run /other-sender /posted, GET /record /arrivals, GET, POST "
            "and DELETE /faults",
            take<take_address<std::optional<Address>>>(options.control)},
           {"--verbose", "", "a line for each request, also where stdout is no terminal", &options.verbose},
           {"--version", "", "prints the version", &options.version},
           {"--help", "", "prints this", &options.help}},
      .ending =
          "adit-rehearsal demo, where it is installed, runs it with Adit and robots and says where the page "
          "is; "
          "adit-rehearsal demo --help says more.\n"
          "AIM: reports, status, mapping; clock:constant and clock:running: of all answers from then on.\n"
          "FAULT: ok, or words with a comma between them:\n"
          "  drop, reset-unrecorded, 401, 429[=COUNT], 500     not recorded\n"
          "  record-then-drop, reset, half-answer, garbage, 500-recorded\n"
          "                                                    recorded, and the answer is lost\n"
          "  record-after=SECONDS, answer-after=SECONDS        late\n"
          "  repeat-answer                                     the answer before it again; not recorded\n"
          "  other-sender                                      another sender's report comes just before\n"
          "  remaining=+N, remaining=-N                        remaining_reports is wrong from then on\n"
          "  retry-after=SECONDS                               in a header",
  };
}

}  // namespace adit::rehearsal
