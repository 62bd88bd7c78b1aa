#include "cli/where.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <optional>

#include "host/interfaces.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"
#include "uplink/socket.hpp"

namespace adit::cli {
namespace {

using settings::Address;

constexpr std::optional<std::uint16_t> kUsualPort = 8000;  // ICD 4, and the example settings

bool is_ipv6(const std::string& address) {
  return address.find(':') != std::string::npos;
}

bool is_any(const std::string& address) {
  in6_addr parsed{};
  if (!is_ipv6(address)) return address == "0.0.0.0";
  return inet_pton(AF_INET6, address.c_str(), &parsed) == 1 && IN6_IS_ADDR_UNSPECIFIED(&parsed);
}

bool is_numeric(const std::string& address) {
  in6_addr parsed{};
  return inet_pton(is_ipv6(address) ? AF_INET6 : AF_INET, address.c_str(), &parsed) == 1;
}

/// fe80::/10. A connection to such an address needs its interface.
bool is_link_local(std::string_view address) {
  return address.starts_with("fe") && address.find(':') == 4 && std::string_view("89ab").contains(address[2]);
}

/// The interface's first address that a listener at `any` accepts.
std::expected<std::string, std::string> address_of(const std::string& interface, const std::string& any) {
  const auto all = ADIT_TRY(host::interfaces());
  for (const host::Interface& each : all) {
    for (std::string_view address : each.addresses) {
      std::string text(icd::cut(address, '/'));
      if (each.name == interface && is_ipv6(text) == is_ipv6(any) && !is_link_local(text)) return text;
    }
  }
  return std::unexpected("interface " + interface + " (team.interface) has no address");
}

}  // namespace

std::expected<Address, std::string> parse_address(std::string_view text) {
  const bool has_port = !text.ends_with(']') && text.contains(':');
  const std::size_t colon = has_port ? text.rfind(':') : text.size();
  std::string_view host = text.substr(0, colon);
  const bool bracketed = host.starts_with('[') && host.ends_with(']');
  if (bracketed) host = host.substr(1, host.size() - 2);
  const std::string address(host);
  const auto port = has_port ? icd::number_in<std::uint16_t>(text.substr(colon + 1)) : kUsualPort;
  if (port.value_or(0) != 0 && is_numeric(address) && is_ipv6(address) == bracketed)
    return Address{address, *port};
  return std::unexpected("expected an address, as 10.0.0.1, 10.0.0.1:8000 or [fd00::1]:8000, got '" +
                         std::string(text) + "'");
}

std::string written(const Address& address) {
  return uplink::authority_of({.address = address.address, .port = address.port, .interface = ""});
}

std::expected<Address, std::string> reach(const settings::Team& team) {
  Address address = team.listen.front();
  if (address.port == 0)
    return std::unexpected("team.listen[0].port is 0 (any free port): give Adit's address by --at ADDR:PORT");
  if (!is_any(address.address)) return address;
  if (team.interface.empty()) {
    address.address = is_ipv6(address.address) ? "::1" : "127.0.0.1";
    return address;
  }
  address.address = ADIT_TRY(address_of(team.interface, address.address));
  return address;
}

}  // namespace adit::cli
