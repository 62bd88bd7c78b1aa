#include "cli/where.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <charconv>
#include <memory>
#include <optional>

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

std::optional<std::uint16_t> parse_port(std::string_view text) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (error != std::errc() || end != text.data() + text.size() || port == 0) return std::nullopt;
  return port;
}

/// Skips link-local addresses, because a connection to one needs its interface.
std::optional<std::string> text_of(const sockaddr& address) {
  char text[INET6_ADDRSTRLEN];
  if (address.sa_family == AF_INET) {
    const auto& ipv4 = reinterpret_cast<const sockaddr_in&>(address);
    return inet_ntop(AF_INET, &ipv4.sin_addr, text, sizeof text);
  }
  if (address.sa_family != AF_INET6) return std::nullopt;
  const auto& ipv6 = reinterpret_cast<const sockaddr_in6&>(address);
  if (IN6_IS_ADDR_LINKLOCAL(&ipv6.sin6_addr)) return std::nullopt;
  return inet_ntop(AF_INET6, &ipv6.sin6_addr, text, sizeof text);
}

/// The interface's first address that a listener at `any` accepts.
std::optional<std::string> address_of(const std::string& interface, const std::string& any) {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return std::nullopt;
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> all(first, freeifaddrs);
  for (const ifaddrs* each = first; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || interface != each->ifa_name) continue;
    auto text = text_of(*each->ifa_addr);
    if (text && is_ipv6(*text) == is_ipv6(any)) return text;
  }
  return std::nullopt;
}

}  // namespace

std::expected<Address, std::string> parse_address(std::string_view text) {
  const bool has_port = !text.ends_with(']') && text.contains(':');
  const std::size_t colon = has_port ? text.rfind(':') : text.size();
  std::string_view host = text.substr(0, colon);
  const bool bracketed = host.starts_with('[') && host.ends_with(']');
  if (bracketed) host = host.substr(1, host.size() - 2);
  const std::string address(host);
  const auto port = has_port ? parse_port(text.substr(colon + 1)) : kUsualPort;
  if (port && is_numeric(address) && is_ipv6(address) == bracketed) return Address{address, *port};
  return std::unexpected("expected an address, as 10.0.0.1, 10.0.0.1:8000 or [fd00::1]:8000, got '" +
                         std::string(text) + "'");
}

std::string written(const Address& address) {
  std::string text;
  if (is_ipv6(address.address)) {
    text.append("[").append(address.address).append("]");
  } else {
    text = address.address;
  }
  return text.append(":").append(std::to_string(address.port));
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
  const auto found = address_of(team.interface, address.address);
  if (!found) return std::unexpected("interface " + team.interface + " (team.interface) has no address");
  address.address = *found;
  return address;
}

}  // namespace adit::cli
