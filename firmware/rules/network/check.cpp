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

struct Endpoint {
  std::string name;
  std::string address;
  std::optional<std::uint32_t> number;  // std::nullopt: no IPv4 address
};

Endpoint endpoint(std::string name, const Address& address) {
  return {std::move(name), address.address, settings::ipv4_of(address.address)};
}

/// The endpoints of the present course.
std::vector<Endpoint> endpoints(const Circumstances& around) {
  return {endpoint("scoring endpoint", around.command_post.scoring),
          endpoint("mapping endpoint", around.command_post.mapping)};
}

std::vector<Endpoint> list_endpoints(const Circumstances& around) {
  auto all = endpoints(around);
  for (const settings::Course& course : around.courses) {
    all.push_back(endpoint("scoring endpoint of course " + course.name, course.scoring));
    all.push_back(endpoint("mapping endpoint of course " + course.name, course.mapping));
  }
  return all;
}

/// Warns of endpoints that the box could not reach.
void warn_of_lost_endpoints(const Numbers& wanted, const Circumstances& around,
                            std::vector<std::string>& warnings) {
  for (const auto& [name, address, number] : endpoints(around)) {
    if (!number || wanted.gateway || on_link(wanted, *number) != nullptr) continue;
    warnings.push_back(icd::sentence("the ", name, " ", address, " cannot be reached: ",
                                     wanted.command_post.empty()
                                         ? "the box has no address on that side"
                                         : icd::sentence("it is in no subnet of ", command_post_text(wanted),
                                                         ", and there is no gateway")));
  }
}

void warn_operator(const Numbers& wanted, const std::optional<Numbers>& present, const Circumstances& around,
                   std::vector<std::string>& warnings) {
  const auto asker = settings::ipv4_of(around.asker);
  if (present && present->mode == wanted.mode && present->team == wanted.team) return;
  const std::string within =
      icd::sentence("within ", std::chrono::ceil<std::chrono::seconds>(around.confirm_within).count(),
                    " s, or the box returns to the old addresses");
  const std::string page = page_at(wanted, around.listen, around.name);
  if (wanted.mode != Mode::Static) {
    warnings.push_back(icd::sentence("the page moves to an address that is not yet known: open ", page,
                                     " and confirm ", within));
  } else if (asker && (wanted.team.contains(*asker) || asker.value() >> 24 == 127)) {
    warnings.push_back(icd::sentence("the page moves: open ", page, " and confirm ", within));
  } else {
    warnings.push_back(icd::sentence("this cuts you off: your address ", around.asker, " is not in ",
                                     to_text(wanted.team), ". Give your device an address there, open ", page,
                                     " and confirm ", within));
  }
}

/// The addresses with which adit.service and adit.socket exchange packets (IPAddressAllow=). DHCP and
/// link-local addresses are not in the numbers.
void check_team_is_private(const Numbers& wanted, std::vector<settings::Error>& errors) {
  constexpr Subnet kPrivate[] = {{0x0a000000, 8}, {0xac100000, 12}, {0xc0a80000, 16}};
  const std::uint32_t address = wanted.team.address;
  if (wanted.mode != Mode::Static ||
      std::ranges::any_of(kPrivate, [&](const Subnet& each) { return each.contains(address); }))
    return;
  errors.push_back(
      {"team.address", icd::sentence(settings::ipv4_text(address),
                                     " is not a private address, and the box answers no other: choose one in "
                                     "10.0.0.0/8, 172.16.0.0/12 or 192.168.0.0/16")});
}

void check_listening(const Numbers& wanted, const Circumstances& around,
                     std::vector<settings::Error>& errors) {
  const bool fixed = wanted.mode == Mode::Static;
  const std::string address = fixed ? settings::ipv4_text(wanted.team.address) : "";
  const bool reached = std::ranges::any_of(around.listen, [&](const Address& listen) {
    return is_any(listen.address) || listen.address == address;
  });
  if (reached || around.listen.empty()) return;
  errors.push_back({fixed ? "team.address" : "team.mode",
                    icd::sentence("Adit would not be reachable ",
                                  fixed ? "at " + address : "at an address that is not yet known",
                                  ": the settings' team.listen has only ", around.listen.front().address,
                                  "; set it to 0.0.0.0, for every address of team.interface")});
}

std::vector<Difference> differences(const Numbers& wanted, const std::optional<Numbers>& present) {
  const auto rows = [](const Numbers& numbers) {
    const bool fixed = numbers.mode == Mode::Static;
    return std::array<std::pair<const char*, std::string>, 5>{
        {{"team.mode", std::string(name_of(numbers.mode))},
         {"team.address", fixed ? settings::ipv4_text(numbers.team.address) : ""},
         {"team.prefix", fixed ? std::to_string(numbers.team.prefix) : ""},
         {"command_post.addresses", numbers.command_post.empty() ? "" : command_post_text(numbers)},
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

std::string page_at(const Numbers& numbers, const std::vector<Address>& listen, const std::string& name) {
  const std::uint16_t port = listen.empty() ? kHttp : listen.front().port;
  const std::string host = icd::sentence(
      "http://", numbers.mode == Mode::Static ? settings::ipv4_text(numbers.team.address) : name);
  return port == kHttp ? host : icd::sentence(host, ":", port);
}

std::string overlap_of(const Numbers& wanted, const Circumstances& around) {
  if (wanted.mode != Mode::Static) return "";
  const auto is_in_the_way = [&wanted](const Subnet& each) { return settings::overlaps(wanted.team, each); };
  const auto known = settings::command_post_subnets();  // ICD 3
  if (const auto found = std::ranges::find_if(known, is_in_the_way); found != known.end())
    return to_text(*found);
  const auto own = std::ranges::find_if(wanted.command_post, is_in_the_way);
  if (own != wanted.command_post.end()) return to_text(*own);
  for (const auto& [name, address, number] : list_endpoints(around)) {
    if (number && wanted.team.contains(*number)) return icd::sentence("the ", name, " ", address);
  }
  return "";
}

Findings check(const Numbers& wanted, const std::optional<Numbers>& present, const Circumstances& around) {
  Findings findings;
  findings.changes = differences(wanted, present);
  if (const std::string what = overlap_of(wanted, around); !what.empty()) {
    const std::string overlaps =
        icd::sentence(to_text(wanted.team), " overlaps ", what, " on the Command Post's side: ");
    if (around.allow_overlap) {
      findings.warnings.push_back(overlaps + "allowed, but a robot cannot reach both");
    } else {
      findings.errors.push_back(
          {"team.address", overlaps + "choose another subnet, or allow it by network.allow_overlap"});
    }
  }
  check_team_is_private(wanted, findings.errors);
  check_listening(wanted, around, findings.errors);
  warn_of_lost_endpoints(wanted, around, findings.warnings);
  warn_operator(wanted, present, around, findings.warnings);
  return findings;
}

}  // namespace adit::network
