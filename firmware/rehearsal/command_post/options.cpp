#include "rehearsal/command_post/options.hpp"

#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <string_view>

namespace adit::rehearsal {

const char* const kUsage =
    "adit-rehearsal: a Command Post to rehearse against\n"
    "  --scoring ADDR:PORT     scoring endpoint (port 0: any)\n"
    "  --mapping ADDR:PORT     mapping endpoint\n"
    "  --secrets DIR           scoring.token and mapping.token\n"
    "  [--artifacts CSV]       true artifacts: type,x,y,z\n"
    "  [--transcript DIR]      write down all that comes in\n"
    "  [--transcript-mb N]     then no more pictures of maps, only lines (2048)\n"
    "  [--as-measured]         behave as the public test servers do, not as the ICD says\n"
    "  [--team NAME]           (adit)\n"
    "  [--run ID]              (1)\n"
    "  [--duration SECONDS]    length of the run (3600)\n"
    "  [--reports N]           allotment of artifact reports (45)\n"
    "  [--rate HZ]             429 above it, for each URI (1; 0: no limit)\n"
    "  [--not-started]         the run waits for POST /start on the control port\n"
    "  [--fault AIM:FAULT]     what goes wrong with the next request of an aim; may be given often\n"
    "  [--fault-rate AIM:FAULT=RATE]  what goes wrong with that part of them (0 to 1), at random\n"
    "  [--seed N]              of that randomness (1)\n"
    "  [--control ADDR:PORT]   POST /start /stop /resume /end /new-run /other-sender, GET /record,\n"
    "                          GET, POST and DELETE /faults\n"
    "  [--verbose]             a line for each request, also where stdout is no terminal\n"
    "\n"
    "AIM: reports, status, mapping; clock:constant and clock:running: of all answers from then on.\n"
    "FAULT: ok, or words with a comma between them:\n"
    "  drop, reset-unrecorded, 401, 429[=COUNT], 500     not recorded\n"
    "  record-then-drop, reset, half-answer, garbage, 500-recorded\n"
    "                                                    recorded, and the answer is lost\n"
    "  record-after=SECONDS, answer-after=SECONDS        late\n"
    "  other-sender                                      another sender's report comes just before\n"
    "  remaining=+N, remaining=-N                        remaining_reports is wrong from then on\n"
    "  retry-after=SECONDS                               in a header\n";

namespace {

using Error = std::optional<std::string>;
using Setter = std::function<bool(const std::string&)>;

template <class Number>
bool read_number(const std::string& text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

bool read_not_negative(const std::string& text, double& number) {
  return read_number(text, number) && std::isfinite(number) && number >= 0;
}

bool read_address(const std::string& text, Address& address) {
  const auto colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0) return false;
  address.host = text.substr(0, colon);
  if (address.host.starts_with('[') && address.host.ends_with(']')) {
    address.host = address.host.substr(1, address.host.size() - 2);
  }
  return !address.host.empty() && read_number(text.substr(colon + 1), address.port);
}

std::map<std::string, Setter, std::less<>> setters(Options& options) {
  const auto text = [](std::string& place) {
    return [&place](const std::string& value) {
      place = value;
      return !value.empty();
    };
  };
  const auto listed = [](std::vector<std::string>& list) {
    return [&list](const std::string& value) {
      list.push_back(value);
      return true;
    };
  };
  return {
      {"--scoring", [&](const auto& value) { return read_address(value, options.scoring); }},
      {"--mapping", [&](const auto& value) { return read_address(value, options.mapping); }},
      {"--control", [&](const auto& value) { return read_address(value, options.control.emplace()); }},
      {"--secrets", text(options.secrets)},
      {"--artifacts", text(options.artifacts)},
      {"--transcript", text(options.transcript)},
      {"--team", text(options.run.team)},
      {"--run", text(options.run.id)},
      {"--reports",
       [&](const auto& value) {
         return read_number(value, options.run.reports) && options.run.reports >= 0;
       }},
      {"--rate", [&](const auto& value) { return read_not_negative(value, options.rate.emplace()); }},
      {"--fault", listed(options.faults)},
      {"--fault-rate", listed(options.fault_rates)},
      {"--seed", [&](const auto& value) { return read_number(value, options.seed); }},
      {"--duration",
       [&](const auto& value) {
         double seconds = 0;
         const bool good = read_not_negative(value, seconds);
         options.run.length = std::chrono::duration<double>(seconds);
         return good;
       }},
      {"--transcript-mb",
       [&](const auto& value) {
         std::uint32_t mb = 0;
         const bool good = read_number(value, mb);
         options.transcript_bytes = std::uint64_t{mb} << 20;
         return good;
       }},
  };
}

std::map<std::string, std::function<void()>, std::less<>> switches(Options& options) {
  return {
      {"--as-measured",
       [&] {
         options.manner = Manner::AsMeasured;
         options.run.renames = false;
       }},
      {"--not-started", [&] { options.not_started = true; }},
      {"--verbose", [&] { options.verbose = true; }},
      {"--help", [&] { options.help = true; }},
  };
}

Error missing(const Options& options) {
  if (options.help) return std::nullopt;
  if (options.scoring.host.empty()) return "--scoring ADDR:PORT is missing";
  if (options.mapping.host.empty()) return "--mapping ADDR:PORT is missing";
  if (options.secrets.empty()) return "--secrets DIR is missing";
  return std::nullopt;
}

}  // namespace

std::expected<Options, std::string> read_options(std::span<const char* const> arguments) {
  Options options;
  const auto with_value = setters(options);
  const auto alone = switches(options);
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view name = arguments[i];
    if (const auto found = alone.find(name); found != alone.end()) {
      found->second();
      continue;
    }
    const auto found = with_value.find(name);
    if (found == with_value.end()) return std::unexpected("unknown option " + std::string(name));
    if (++i == arguments.size()) return std::unexpected(std::string(name) + " needs a value");
    if (!found->second(arguments[i])) {
      return std::unexpected(std::string(name) + ": cannot take '" + arguments[i] + "'");
    }
  }
  if (auto error = missing(options)) return std::unexpected(std::move(*error));
  return options;
}

}  // namespace adit::rehearsal
