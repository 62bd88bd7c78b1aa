#include "settings/network_rules.hpp"

#include <optional>
#include <string>

#include "icd/sentence.hpp"
#include "settings/subnet.hpp"

namespace adit::settings {
namespace {

/// The subnet that `address` is in. Nothing where that is no IPv4 address.
std::optional<Subnet> subnet_of(const std::string& address, std::uint32_t prefix) {
  const auto host = ipv4_of(address);
  if (!host) return std::nullopt;
  return Subnet{*host, static_cast<std::uint8_t>(prefix)};
}

/// An address that the box could have in that subnet.
void check_host(const std::string& path, const std::string& address, const Subnet& subnet,
                std::vector<Error>& errors) {
  const std::uint32_t host = ipv4_of(address).value_or(0);
  const std::uint32_t first = host >> 24;
  if (first == 0 || first == 127 || first >= 224) {
    errors.push_back({path, address + " is no address that a host can have"});
  } else if (host == subnet.first()) {
    errors.push_back({path, icd::sentence(address, " is the subnet ", written(subnet), " itself")});
  } else if (host == subnet.last()) {
    errors.push_back({path, icd::sentence(address, " is the broadcast address of ", written(subnet))});
  }
}

void check_command_post(const Network::CommandPost& network, std::vector<Error>& errors) {
  const auto subnet = subnet_of(network.address, network.prefix);
  if (subnet) check_host("network.command_post.address", network.address, *subnet, errors);
  if (network.gateway.empty()) return;
  const std::string path = "network.command_post.gateway";
  if (!subnet) {
    errors.push_back({path, "a gateway is set, but network.command_post.address is not"});
  } else if (!subnet->contains(ipv4_of(network.gateway).value_or(0))) {
    errors.push_back({path, icd::sentence(network.gateway, " is not in ", written(*subnet),
                                          ", the subnet of network.command_post.address")});
  } else if (network.gateway == network.address) {
    errors.push_back({path, "the same as network.command_post.address"});
  } else {
    check_host(path, network.gateway, *subnet, errors);
  }
}

/// The endpoint's path, where it lies in the team's subnet.
std::string endpoint_within(const Subnet& team, const Settings& settings) {
  const auto within = [&team](const Address& address) {
    const auto host = ipv4_of(address.address);
    return host && team.contains(*host);
  };
  if (within(settings.command_post.scoring)) return "command_post.scoring.address";
  if (within(settings.command_post.mapping)) return "command_post.mapping.address";
  for (std::size_t i = 0; i < settings.courses.size(); ++i) {
    if (within(settings.courses[i].scoring)) return icd::sentence("courses[", i, "].scoring.address");
    if (within(settings.courses[i].mapping)) return icd::sentence("courses[", i, "].mapping.address");
  }
  return "";
}

}  // namespace

std::string overlap(const Settings& settings) {
  const Network& network = settings.network;
  const auto team = subnet_of(network.team.address, network.team.prefix);
  if (!team) return "";
  for (const Subnet& darpa : command_post_subnets()) {
    if (overlaps(*team, darpa)) {
      return icd::sentence(written(*team), " overlaps ", written(darpa),
                           ", which the Command Post uses (ICD 3)");
    }
  }
  const auto post = subnet_of(network.command_post.address, network.command_post.prefix);
  if (post && overlaps(*team, *post)) {
    return icd::sentence(written(*team), " overlaps ", written(*post),
                         ", the subnet of network.command_post.address");
  }
  const std::string endpoint = endpoint_within(*team, settings);
  return endpoint.empty() ? "" : icd::sentence(written(*team), " holds ", endpoint);
}

std::vector<Error> network_faults(const Settings& settings) {
  std::vector<Error> errors;
  const Network& network = settings.network;
  if (const auto team = subnet_of(network.team.address, network.team.prefix)) {
    check_host("network.team.address", network.team.address, *team, errors);
  }
  check_command_post(network.command_post, errors);
  if (network.allow_overlap) return errors;
  if (const std::string what = overlap(settings); !what.empty()) {
    errors.push_back({"network.team.address",
                      what + ": choose another subnet for the team, or allow it by network.allow_overlap"});
  }
  return errors;
}

}  // namespace adit::settings
