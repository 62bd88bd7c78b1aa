#include "network/networkd.hpp"

namespace adit::network {
namespace {

/// The address stays without a carrier: a cable that is pulled and put back costs no more than that. Whatever
/// else the interface had goes (KeepConfiguration=no), or an address that was changed would stay beside the
/// new one. Whether anybody else has the address (RFC 5227) is asked before this is written, and so with an
/// answer; networkd would ask for seconds in which there is no address at all, and where it is told another
/// one meanwhile, version 252 takes up both.
std::string file(const std::string& interface, const settings::Subnet& host) {
  return "# Written by adit-network: to change it, use Adit's page.\n"
         "[Match]\n"
         "Name=" +
         interface +
         "\n\n"
         "[Link]\n"
         "RequiredForOnline=no\n"
         "\n"
         "[Network]\n"
         "DHCP=no\n"
         "LinkLocalAddressing=no\n"
         "IPv6AcceptRA=no\n"
         "LLMNR=no\n"
         "MulticastDNS=no\n"
         "KeepConfiguration=no\n"
         "ConfigureWithoutCarrier=yes\n"
         "IgnoreCarrierLoss=yes\n"
         "\n"
         "[Address]\n"
         "Address=" +
         host_text(host) +
         "\n"
         "DuplicateAddressDetection=none\n";
}

}  // namespace

std::string team_file(const std::string& interface, const Numbers& numbers) {
  return file(interface, numbers.team);
}

std::string command_post_file(const std::string& interface, const Numbers& numbers) {
  std::string text = file(interface, numbers.command_post);
  if (!numbers.gateway) return text;
  for (const settings::Subnet& subnet : settings::command_post_subnets()) {
    if (subnet.first() == numbers.command_post.first() && subnet.prefix == numbers.command_post.prefix)
      continue;
    text.append("\n[Route]\nDestination=").append(written(subnet));
    text.append("\nGateway=").append(settings::ipv4_text(*numbers.gateway)).append("\n");
  }
  return text;
}

}  // namespace adit::network
