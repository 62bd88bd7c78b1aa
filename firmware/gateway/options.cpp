#include "gateway/options.hpp"

#include "host/command_line.hpp"

namespace adit::gateway {
namespace {

constexpr host::Flag<Options> kFlags[] = {{"--help", &Options::help}, {"--version", &Options::version}};
constexpr host::Value<Options> kValues[] = {
    {"--settings", &Options::settings}, {"--secrets", &Options::secrets}, {"--state", &Options::state},
    {"--network", &Options::network},   {"--update", &Options::update},   {"--board", &Options::board},
    {"--notices", &Options::notices}};

}  // namespace

const char* const kUsage =
    "Usage: aditd --settings FILE --secrets DIR --state DIR\n"
    "\n"
    "Adit's gateway between a robot team and the Command Post.\n"
    "\n"
    "  --settings FILE  the settings (JSON, version 1) unless others were saved; `adit check FILE` explains\n"
    "                   what is wrong with them\n"
    "  --secrets DIR    may hold scoring.token, mapping.token, team.token and label.code,\n"
    "                   readable by nobody else\n"
    "  --state DIR      where the ledger of reports is kept, and what is set up by the page: settings.json "
    "and\n"
    "                   secrets/, which count before the other two; made where it is absent\n"
    "  --network DIR    where adit-network tells how it stands; /run/adit-network if not given\n"
    "  --update DIR     where adit-update tells how it stands; /run/adit-update if not given\n"
    "  --board FILE     what the board is, and where its lights and its button are: counts before the "
    "settings'\n"
    "                   panel; may be absent\n"
    "  --notices DIR    sentences for the operator, a file each, of whatever started the box; "
    "/run/adit-notices if not\n"
    "                   given\n"
    "  --version        prints the version\n"
    "  --help           prints this\n"
    "\n"
    "What waits and who is logged in is kept across a restart in $RUNTIME_DIRECTORY, or else in the state "
    "folder.\n"
    "Exits 0 after SIGTERM or SIGINT, 1 where it cannot start (and says why), 2 on a wrong command line.\n";

std::expected<Options, std::string> parse_options(std::span<char* const> arguments) {
  auto options = host::read_command_line<Options>(arguments, kFlags, kValues, host::Empty::Taken);
  if (!options) return options;
  if (options->help || options->version) return options;
  if (options->settings.empty()) return std::unexpected("--settings FILE is missing");
  if (options->secrets.empty()) return std::unexpected("--secrets DIR is missing");
  if (options->state.empty()) return std::unexpected("--state DIR is missing");
  return options;
}

}  // namespace adit::gateway
