#include "network/check.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "icd/sentence.hpp"

namespace adit::network {
namespace {

using settings::Address;
using settings::Subnet;

constexpr std::uint16_t kHttp = 80;

bool is_any(const std::string& address) {
  return address == "0.0.0.0" || address == "::";
}

/// What the team's subnet overlaps of the Command Post's network, in words.
std::vector<std::string> overlaps_of(const Numbers& wanted, const Circumstances& around) {
  std::vector<std::string> what;
  const std::string team = written(wanted.team);
  for (const Subnet& each : settings::command_post_subnets()) {
    if (settings::overlaps(wanted.team, each)) {
      what.push_back(icd::sentence(team, " overlaps ", written(each),
                                   ", which the Command Post's network uses (ICD 3)"));
    }
  }
  if (settings::overlaps(wanted.team, wanted.command_post)) {
    what.push_back(
        icd::sentence(team, " overlaps ", written(wanted.command_post), " on the Command Post's side"));
  }
  const std::array endpoints = {std::pair("scoring", around.command_post.scoring.address),
                                std::pair("mapping", around.command_post.mapping.address)};
  for (const auto& [name, address] : endpoints) {
    const auto number = settings::ipv4_of(address);
    if (number && wanted.team.contains(*number)) {
      what.push_back(icd::sentence("the ", name, " endpoint ", address, " lies in ", team));
    }
  }
  return what;
}

/// An endpoint that the box would find no way to.
void warn_of_lost_endpoints(const Numbers& wanted, const Circumstances& around,
                            std::vector<std::string>& warnings) {
  const std::array endpoints = {std::pair("scoring", around.command_post.scoring.address),
                                std::pair("mapping", around.command_post.mapping.address)};
  for (const auto& [name, address] : endpoints) {
    const auto number = settings::ipv4_of(address);
    if (!number || wanted.command_post.contains(*number)) continue;
    const bool nominal = std::ranges::any_of(settings::command_post_subnets(),
                                             [&](const Subnet& each) { return each.contains(*number); });
    if (nominal && wanted.gateway) continue;
    warnings.push_back(
        icd::sentence("the ", name, " endpoint ", address, " cannot be reached: it is not in ",
                      written(wanted.command_post),
                      nominal ? ", and there is no gateway"
                              : ", and no gateway leads there (only to the Command Post's own subnets)"));
  }
}

void warn_the_asker(const Numbers& wanted, const std::optional<Numbers>& present, const Circumstances& around,
                    std::vector<std::string>& warnings) {
  const auto asker = settings::ipv4_of(around.asker);
  if (present && present->team == wanted.team) return;
  const std::string within =
      icd::sentence("within ", std::chrono::ceil<std::chrono::seconds>(around.confirm_within).count(),
                    " s, or it is taken back");
  const std::string page = page_at(wanted, around.listen);
  if (asker && (wanted.team.contains(*asker) || asker.value() >> 24 == 127)) {
    warnings.push_back(icd::sentence("the page moves: open ", page, " and confirm ", within));
  } else {
    warnings.push_back(icd::sentence("this cuts you off: your address ", around.asker, " is not in ",
                                     written(wanted.team), ". Give your device an address there, open ", page,
                                     " and confirm ", within));
  }
}

void check_listening(const Numbers& wanted, const Circumstances& around,
                     std::vector<settings::Error>& errors) {
  const std::string address = settings::ipv4_text(wanted.team.address);
  const bool reached = std::ranges::any_of(around.listen, [&](const Address& listen) {
    return is_any(listen.address) || listen.address == address;
  });
  if (reached || around.listen.empty()) return;
  errors.push_back(
      {"team.address", icd::sentence("nothing would be served at ", address,
                                     ": the settings' team.listen has only ", around.listen.front().address,
                                     "; set it to 0.0.0.0, which is every address of team.interface")});
}

std::vector<Difference> differences(const Numbers& wanted, const std::optional<Numbers>& present) {
  const auto rows = [](const Numbers& numbers) {
    return std::array<std::pair<const char*, std::string>, 5>{
        {{"team.address", settings::ipv4_text(numbers.team.address)},
         {"team.prefix", std::to_string(numbers.team.prefix)},
         {"command_post.address", settings::ipv4_text(numbers.command_post.address)},
         {"command_post.prefix", std::to_string(numbers.command_post.prefix)},
         {"command_post.gateway", numbers.gateway ? settings::ipv4_text(*numbers.gateway) : ""}}};
  };
  const auto to = rows(wanted);
  std::vector<Difference> found;
  for (std::size_t i = 0; i < to.size(); ++i) {
    const std::string from = present ? rows(*present)[i].second : "";
    if (from != to[i].second) found.push_back({to[i].first, from, to[i].second});
  }
  return found;
}

}  // namespace

std::string page_at(const Numbers& numbers, const std::vector<Address>& listen) {
  const std::uint16_t port = listen.empty() ? kHttp : listen.front().port;
  const std::string host = icd::sentence("http://", settings::ipv4_text(numbers.team.address));
  return port == kHttp ? host : icd::sentence(host, ":", port);
}

Verdict check(const Numbers& wanted, const std::optional<Numbers>& present, const Circumstances& around) {
  Verdict verdict;
  verdict.changes = differences(wanted, present);
  for (std::string& what : overlaps_of(wanted, around)) {
    if (around.allow_overlap) {
      verdict.warnings.push_back(what + "; that is allowed by network.allow_overlap");
    } else {
      verdict.errors.push_back(
          {"team.address", what + "; choose another subnet, or allow it by network.allow_overlap"});
    }
  }
  check_listening(wanted, around, verdict.errors);
  warn_of_lost_endpoints(wanted, around, verdict.warnings);
  warn_the_asker(wanted, present, around, verdict.warnings);
  return verdict;
}

}  // namespace adit::network
