#include "applier/update_options.hpp"

#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

namespace adit::applier {
namespace {

constexpr std::pair<std::string_view, std::string UpdateOptions::*> kValues[] = {
    {"--wanted", &UpdateOptions::wanted},         {"--status", &UpdateOptions::status},
    {"--state", &UpdateOptions::state},           {"--stick", &UpdateOptions::stick},
    {"--os-release", &UpdateOptions::os_release}, {"--rauc", &UpdateOptions::rauc},
    {"--systemctl", &UpdateOptions::systemctl}};
constexpr std::pair<std::string_view, bool UpdateOptions::*> kFlags[] = {
    {"good", &UpdateOptions::good}, {"--help", &UpdateOptions::help}, {"--version", &UpdateOptions::version}};

template <class Member, std::size_t kSize>
Member member_named(const std::pair<std::string_view, Member> (&table)[kSize], std::string_view word) {
  for (const auto& [name, member] : table) {
    if (name == word) return member;
  }
  return nullptr;
}

std::optional<std::chrono::seconds> seconds_in(std::string_view text) {
  int seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc{} || end != text.data() + text.size() || seconds < 1 || seconds > 3600)
    return std::nullopt;
  return std::chrono::seconds(seconds);
}

}  // namespace

const char* const kUpdateUsage =
    "Usage: adit-update [good] [OPTION VALUE]...\n"
    "\n"
    "Updates the box, by RAUC, as aditd asks: checks a bundle, installs it into the slot that does not run,\n"
    "and starts the machine anew. Ends once nothing is asked for.\n"
    "\n"
    "  good              watches a start of the machine instead: marks the slot good once aditd is healthy, "
    "or\n"
    "                    starts the machine anew where a slot on trial does not become so\n"
    "  --within SECONDS  how long a slot on trial may take for that (300)\n"
    "  --wanted DIR      where aditd asks (/var/lib/private/adit)\n"
    "  --status DIR      where it is answered (/run/adit-update)\n"
    "  --state DIR       where what became of the last update is kept (/var/lib/adit-update)\n"
    "  --stick DIR       where a USB stick is mounted (/run/adit-stick)\n"
    "  --os-release FILE says by VERSION_ID which version runs (/etc/os-release)\n"
    "  --rauc CMD        RAUC (rauc)\n"
    "  --systemctl CMD   systemd (systemctl)\n"
    "  --version         prints the version\n"
    "  --help            prints this\n"
    "\n"
    "Exits 0 once it is done, 1 where it cannot do its work (and says why), 2 on a wrong command line.\n";

std::expected<UpdateOptions, std::string> parse_update_options(std::span<char* const> arguments) {
  UpdateOptions options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view word = arguments[i];
    if (const auto flag = member_named(kFlags, word)) {
      options.*flag = true;
    } else if (word == "--within" && i + 1 < arguments.size()) {
      const auto seconds = seconds_in(arguments[++i]);
      if (!seconds) return std::unexpected("--within wants 1 to 3600 seconds");
      options.within = *seconds;
    } else if (const auto member = member_named(kValues, word); member == nullptr) {
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
