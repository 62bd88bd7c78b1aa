#include "applier/import.hpp"
#include "host/command_line.hpp"

namespace adit::applier {
namespace {

constexpr host::Flag<ImportOptions> kFlags[] = {{"--help", &ImportOptions::help},
                                                {"--version", &ImportOptions::version}};
constexpr host::Value<ImportOptions> kValues[] = {{"--card", &ImportOptions::card},
                                                  {"--state", &ImportOptions::state},
                                                  {"--network", &ImportOptions::network},
                                                  {"--given", &ImportOptions::given},
                                                  {"--memory", &ImportOptions::in_memory}};

}  // namespace

const char* const kImportUsage =
    "Usage: adit-import [OPTION VALUE]...\n"
    "\n"
    "Takes the settings, the network's numbers and the tokens that somebody put on Adit's boot partition, "
    "all "
    "of\n"
    "them or, where anything is wrong, nothing; taken.txt beside them says what became of each. Runs before "
    "aditd.\n"
    "\n"
    "  --card DIR     where they were put: settings.json, network.json, secrets/*.token (/boot/adit)\n"
    "  --state DIR    aditd's state (/var/lib/private/adit)\n"
    "  --network DIR  adit-network's state (/var/lib/adit-network)\n"
    "  --given FILE   the settings that count until others are saved (/etc/adit/settings.json)\n"
    "  --memory FILE  where it is there, the state is lost at the next start, and what is taken stays on the "
    "card\n"
    "                 (/run/adit-notices/state)\n"
    "  --version      prints the version\n"
    "  --help         prints this\n"
    "\n"
    "Exits 0 also where there was nothing, or what was there is wrong; 1 where what is right could not be "
    "taken\n"
    "(and says why); 2 on a wrong command line.\n";

std::expected<ImportOptions, std::string> parse_import_options(std::span<char* const> arguments) {
  return host::read_command_line<ImportOptions>(arguments, kFlags, kValues);
}

}  // namespace adit::applier
