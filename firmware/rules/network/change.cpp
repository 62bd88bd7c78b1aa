#include "network/change.hpp"

#include <algorithm>
#include <utility>

#include "icd/sentence.hpp"

namespace adit::network {

void Change::on_interrupted() {
  status_.ended = ChangeOutcome::Reverted;
  status_.why = "the change was not confirmed before adit-network ended";
}

void Change::request_change(const ChangeRequest& wanted, Instant now) {
  if (status_.pending) return;  // the sender sees in the status that its request was ignored
  if (status_.kept == wanted.numbers) {
    status_.ended_nonce = wanted.nonce;
    status_.ended = ChangeOutcome::Confirmed;
    status_.why = "the box already has these addresses";
    return;
  }
  status_.pending = Pending{wanted.nonce, wanted.numbers, now + wanted.confirm_within, wanted.confirm_within};
  if (const auto applied = hands_.apply(wanted.numbers); !applied) {
    revert("the change could not be applied: " + applied.error(), now);
  }
}

void Change::decide(const Decision& word, Instant now) {
  if (!status_.pending || word.nonce != status_.pending->nonce || try_at_) return;
  if (word.what == Decision::Command::Revert) return revert("a user reverted the change", now);
  const Numbers numbers = status_.pending->wanted;
  if (const auto kept = hands_.keep(numbers); !kept) {
    return revert("the change was confirmed, but could not be stored: " + kept.error(), now);
  }
  status_.kept = numbers;
  end(ChangeOutcome::Confirmed, "");
}

std::expected<void, std::string> Change::forget(Instant now) {
  auto kept = hands_.forget();
  if (!kept) {
    if (status_.pending && !try_at_) revert("a factory reset forgets all addresses", now);
    return std::unexpected(std::move(kept.error()));
  }
  status_.kept = *kept;
  status_.endpoints = {};
  if (status_.pending) end(ChangeOutcome::Reverted, "a factory reset forgot all addresses");
  return {};
}

void Change::tick(Instant now) {
  if (try_at_) {
    if (now >= *try_at_) try_to_revert(now);
  } else if (status_.pending && now >= status_.pending->until) {
    revert(
        icd::sentence("the change was not confirmed within ",
                      std::chrono::ceil<std::chrono::seconds>(status_.pending->confirm_within).count(), " s"),
        now);
  }
}

void Change::stop(Instant now) {
  if (try_at_) return try_to_revert(now);
  if (status_.pending) revert("adit-network was stopped", now);
}

std::optional<Instant> Change::wake() const {
  if (try_at_) return try_at_;
  return status_.pending ? std::optional(status_.pending->until) : std::nullopt;
}

void Change::revert(std::string why, Instant now) {
  why_ = std::move(why);
  tries_ = 0;
  try_to_revert(now);
}

void Change::try_to_revert(Instant now) {
  const auto reverted = hands_.revert();
  if (reverted) return end(ChangeOutcome::Reverted, why_);
  if (++tries_ == kTries) {
    return end(ChangeOutcome::Reverted,
               why_ + "; the old addresses are not in effect yet: retrying: " + reverted.error());
  }
  try_at_ = now + kTryAgain;
}

void Change::end(ChangeOutcome how, std::string why) {
  status_.ended_nonce = status_.pending->nonce;
  status_.pending.reset();
  status_.ended = how;
  status_.why = std::move(why);
  try_at_.reset();
}

namespace {

using settings::Subnet;

/// The address stays without a carrier (ConfigureWithoutCarrier), so a pulled cable costs only its own time.
/// Other addresses of the interface go (KeepConfiguration=no), or a replaced one would stay beside the new.
constexpr const char* kHead =
    "# Written by adit-network: to change it, use Adit's page.\n"
    "[Match]\n"
    "Name=";
constexpr const char* kBoth =
    "IPv6AcceptRA=no\n"
    "LLMNR=no\n"
    "LLDP=no\n"
    "EmitLLDP=no\n"
    "KeepConfiguration=no\n"
    "ConfigureWithoutCarrier=yes\n";

/// adit-network looks for address conflicts (RFC 5227) before it writes this file. networkd's check would
/// leave the interface without an address for seconds; version 252 sets both if the address changes then.
std::string address(const Subnet& host, bool with_route) {
  return icd::sentence("\n[Address]\nAddress=", host_text(host), with_route ? "" : "\nAddPrefixRoute=no",
                       "\nDuplicateAddressDetection=none\n");
}

std::string table_line() {
  return icd::sentence("Table=", kRouteTable, "\n");
}

/// A route to the subnet of an address. If two addresses share a subnet, the route uses the first.
std::string link_route(const Subnet& host) {
  return icd::sentence("\n[Route]\nDestination=", to_text(host),
                       "\nScope=link\nPreferredSource=", settings::ipv4_text(host.address), "\n") +
         table_line();
}

std::string endpoint_route(std::uint32_t endpoint, std::uint32_t gateway, const Subnet& own) {
  return icd::sentence("\n[Route]\nDestination=", settings::ipv4_text(endpoint),
                       "/32\nGateway=", settings::ipv4_text(gateway),
                       "\nPreferredSource=", settings::ipv4_text(own.address), "\n") +
         table_line();
}

/// Sends sockets bound to the interface, and packets from its addresses, to the table. The second rule also
/// gives the kernel the way back for received packets (rp_filter).
std::string rules(const std::string& interface, const Numbers& numbers) {
  std::string text = icd::sentence("\n[RoutingPolicyRule]\nOutgoingInterface=", interface,
                                   "\nFamily=ipv4\nPriority=", kRouteTable, "\n") +
                     table_line();
  for (const Subnet& each : numbers.command_post) {
    text += icd::sentence("\n[RoutingPolicyRule]\nFrom=", settings::ipv4_text(each.address),
                          "/32\nPriority=", kRouteTable, "\n") +
            table_line();
  }
  return text;
}

}  // namespace

std::string team_file(const std::string& interface, const Numbers& numbers) {
  const bool asks = numbers.mode == Mode::Dhcp;
  std::string text = kHead + interface +
                     "\n\n[Link]\nRequiredForOnline=no\n\n[Network]\n"
                     "LinkLocalAddressing=yes\n"
                     "MulticastDNS=yes\n" +
                     kBoth;
  text += asks ? "DHCP=ipv4\n" : "DHCP=no\n";
  // Addresses from another network's DHCP are useless here. A cable moved within a network keeps its lease.
  text += asks ? "IgnoreCarrierLoss=5s\n" : "IgnoreCarrierLoss=yes\n";
  if (numbers.mode == Mode::Static) text += address(numbers.team, true);
  if (asks) {
    text +=
        "\n[DHCPv4]\nUseDNS=no\nUseNTP=no\nUseSIP=no\nUseHostname=no\nUseDomains=no\nUseTimezone=no\n"
        "UseGateway=no\nUseRoutes=no\nUseMTU=no\n";
  }
  return text;
}

std::string command_post_file(const std::string& interface, const Numbers& numbers,
                              const std::vector<std::uint32_t>& endpoints) {
  std::string text = kHead + interface +
                     "\n\n[Link]\nRequiredForOnline=no\nMulticast=no\n\n[Network]\n"
                     "DHCP=no\n"
                     "LinkLocalAddressing=no\n"
                     "MulticastDNS=no\n" +
                     kBoth + "IgnoreCarrierLoss=yes\n";
  if (numbers.command_post.empty()) return text;
  std::vector<Subnet> linked;
  for (const Subnet& each : numbers.command_post) {
    text += address(each, false);
    const Subnet subnet{each.first(), each.prefix};
    if (std::ranges::find(linked, subnet) == linked.end()) {
      linked.push_back(subnet);
      text += link_route(each);
    }
  }
  for (const std::uint32_t endpoint : endpoints) {
    if (numbers.gateway && on_link(numbers, endpoint) == nullptr) {
      text += endpoint_route(endpoint, *numbers.gateway, *on_link(numbers, *numbers.gateway));
    }
  }
  return text + rules(interface, numbers);
}

}  // namespace adit::network
