#include <string_view>
#include <utility>

#include "applier/import.hpp"

namespace adit::applier {
namespace {

constexpr std::pair<std::string_view, std::string ImportOptions::*> kValues[] = {
    {"--card", &ImportOptions::card},
    {"--state", &ImportOptions::state},
    {"--network", &ImportOptions::network},
    {"--given", &ImportOptions::given}};

std::string ImportOptions::* member_named(std::string_view word) {
  for (const auto& [name, member] : kValues) {
    if (name == word) return member;
  }
  return nullptr;
}

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
    "  --version      prints the version\n"
    "  --help         prints this\n"
    "\n"
    "Exits 0 also where there was nothing, or what was there is wrong; 1 where what is right could not be "
    "taken\n"
    "(and says why); 2 on a wrong command line.\n";

std::expected<ImportOptions, std::string> parse_import_options(std::span<char* const> arguments) {
  ImportOptions options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view word = arguments[i];
    if (word == "--help") {
      options.help = true;
    } else if (word == "--version") {
      options.version = true;
    } else if (const auto member = member_named(word); member == nullptr) {
      return std::unexpected("unknown word '" + std::string(word) + "'");
    } else if (++i == arguments.size() || *arguments[i] == '\0') {
      return std::unexpected(std::string(word) + " wants a value");
    } else {
      options.*member = arguments[i];
    }
  }
  return options;
}

}  // namespace adit::applier
