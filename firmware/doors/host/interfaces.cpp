#include "host/interfaces.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/utsname.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <memory>
#include <sstream>
#include <system_error>

#include "host/files.hpp"
#include "host/root_program.hpp"
#include "host/service.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::host {
namespace {

constexpr settings::Subnet kLinkLocal{0xa9fe0000, 16};  // RFC 3927

int ones_in(const void* bytes, std::size_t count) {
  const auto* each = static_cast<const std::uint8_t*>(bytes);
  int ones = 0;
  for (std::size_t i = 0; i < count; ++i) ones += std::popcount(each[i]);
  return ones;
}

/// "10.0.0.1/24", or "" if it is not an IP address.
std::string address_text(const sockaddr* address, const sockaddr* mask) {
  char text[INET6_ADDRSTRLEN];
  if (address == nullptr || mask == nullptr) return "";
  int ones = 0;
  const void* bytes = nullptr;
  if (address->sa_family == AF_INET) {
    bytes = &reinterpret_cast<const sockaddr_in*>(address)->sin_addr;
    ones = ones_in(&reinterpret_cast<const sockaddr_in*>(mask)->sin_addr, sizeof(in_addr));
  } else if (address->sa_family == AF_INET6) {
    bytes = &reinterpret_cast<const sockaddr_in6*>(address)->sin6_addr;
    ones = ones_in(&reinterpret_cast<const sockaddr_in6*>(mask)->sin6_addr, sizeof(in6_addr));
  }
  if (bytes == nullptr || inet_ntop(address->sa_family, bytes, text, sizeof text) == nullptr) return "";
  return std::string(text) + "/" + std::to_string(ones);
}

/// The first line of a small kernel file; "" if it cannot be read.
std::string line_in(const std::string& path) {
  const auto file = slurp(path);
  return file ? file->text.substr(0, file->text.find('\n')) : "";
}

/// An address of /proc/net/route, which is hexadecimal in memory order.
std::string address_text(std::uint32_t address) {
  char text[INET_ADDRSTRLEN];
  return inet_ntop(AF_INET, &address, text, sizeof text) == nullptr ? "" : text;
}

}  // namespace

std::expected<std::vector<Interface>, std::string> interfaces() {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0)
    return std::unexpected("cannot read this machine's addresses: " + std::system_category().message(errno));
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> all(first, &freeifaddrs);
  std::vector<Interface> interfaces;
  for (const ifaddrs* each = all.get(); each != nullptr; each = each->ifa_next) {
    auto known = std::ranges::find(interfaces, each->ifa_name, &Interface::name);
    if (known == interfaces.end()) {
      interfaces.push_back({.name = each->ifa_name,
                            .up = (each->ifa_flags & IFF_UP) != 0,
                            .carrier = carrier(each->ifa_name),
                            .addresses = {}});
      known = interfaces.end() - 1;
    }
    if (auto text = address_text(each->ifa_addr, each->ifa_netmask); !text.empty()) {
      known->addresses.push_back(std::move(text));
    }
  }
  return interfaces;
}

std::expected<std::optional<Port>, std::string> port_in(const std::string& sys_class_net,
                                                        const std::string& interface) {
  if (!is_interface_name(interface)) return std::nullopt;
  const std::string folder = sys_class_net + "/" + interface;
  const auto mac = ADIT_TRY(read_optional_file(folder + "/address"));
  if (!mac) return std::nullopt;
  Port port{.mac = mac->substr(0, mac->find('\n')), .mbit = {}, .duplex = line_in(folder + "/duplex")};
  if (port.duplex == "unknown") port.duplex.clear();
  const std::string speed = line_in(folder + "/speed");  // -1 or unreadable: not known
  const auto mbit = icd::number_in<unsigned>(speed);
  if (mbit.value_or(0) > 0) port.mbit = mbit;
  return port;
}

std::expected<std::optional<Port>, std::string> port(const std::string& interface) {
  return port_in("/sys/class/net", interface);
}

std::string local_name() {
  utsname names{};
  const std::string name = uname(&names) == 0 ? names.nodename : "";
  return name.substr(0, name.find('.')) + ".local";
}

std::expected<std::vector<settings::Subnet>, std::string> own_addresses(const std::string& interface) {
  const auto interfaces = ADIT_TRY(host::interfaces());
  std::vector<settings::Subnet> all;
  for (const Interface& each : interfaces) {
    if (each.name != interface) continue;
    for (const std::string& address : each.addresses) {
      if (const auto subnet = settings::parse_subnet(address)) all.push_back(*subnet);
    }
  }
  std::ranges::stable_partition(
      all, [](const settings::Subnet& each) { return !kLinkLocal.contains(each.address); });
  return all;
}

std::expected<std::optional<settings::Subnet>, std::string> own_address(const std::string& interface) {
  const auto all = ADIT_TRY(own_addresses(interface));
  return all.empty() ? std::nullopt : std::optional(all.front());
}

std::vector<Route> routes_in(const std::string& table) {
  std::vector<Route> routes;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string interface;
    std::uint32_t destination = 0, gateway = 0, mask = 0;
    unsigned flags = 0, references = 0, uses = 0, metric = 0;
    words >> interface >> std::hex >> destination >> gateway >> flags >> std::dec >> references >> uses >>
        metric >> std::hex >> mask;
    if (!words) continue;  // the heading
    routes.push_back({.destination = address_text(destination) + "/" + std::to_string(std::popcount(mask)),
                      .gateway = gateway == 0 ? "" : address_text(gateway),
                      .interface = interface,
                      .metric = metric});
  }
  return routes;
}

/// Uses /proc/self, which exists under ProcSubset=pid.
std::vector<Route> routes() {
  const auto file = slurp("/proc/self/net/route");
  return file ? routes_in(file->text) : std::vector<Route>{};
}

}  // namespace adit::host
