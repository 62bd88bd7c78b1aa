#include "network/messages.hpp"

#include <set>

#include "codec/nonce.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::codec {

/// Milliseconds of CLOCK_MONOTONIC.
template <>
struct KindOf<network::Instant> {
  using Milliseconds = KindOf<std::chrono::milliseconds>;
  static Value write(network::Instant instant) {
    return Milliseconds::write(
        std::chrono::duration_cast<std::chrono::milliseconds>(instant.time_since_epoch()));
  }
  static void read(const Field& field, network::Instant& instant) {
    constexpr auto kLast = std::chrono::floor<std::chrono::milliseconds>(network::Instant::duration::max());
    instant = network::Instant(std::chrono::milliseconds(field.integer<std::int64_t>(0, kLast.count())));
  }
  static constexpr Schema schema = {.type = "integer"};
};

}  // namespace adit::codec

namespace adit::network {

static constexpr std::string_view kWordWords[] = {"confirm", "revert"};  // in the order of Decision::Command
static constexpr auto& words_of(Decision::Command /*of*/) {
  return kWordWords;
}

namespace {

using codec::Field;
using codec::member;
using codec::Member;
using codec::Row;

constexpr codec::Form kAddress{[](std::string_view text) { return settings::ipv4_of(text).has_value(); },
                               "an IPv4 address"};

bool is_mac(std::string_view text) {
  constexpr std::size_t kLength = 17;
  if (text.size() != kLength) return false;
  for (std::size_t i = 0; i < kLength; ++i) {
    const std::string_view wanted = i % 3 == 2 ? ":" : "0123456789abcdef";
    if (!wanted.contains(text[i])) return false;
  }
  return true;
}
constexpr codec::Form kMac{is_mac, "a MAC address"};

void read_taken(const Field& list, void* addresses) {
  if (list.size() > kMostTaken) return list.refuse("expected at most ", kMostTaken);
  codec::kind_of<std::vector<AddressConflict>>.read(list, addresses);
}
constexpr codec::RowKind kTaken = {.write = codec::kind_of<std::vector<AddressConflict>>.write,
                                   .read = read_taken,
                                   .schema = codec::kind_of<std::vector<AddressConflict>>.schema};

void read_ports(const Field& list, void* ports) {
  if (list.size() > kMostTeamPorts) return list.refuse("expected at most ", kMostTeamPorts);
  codec::kind_of<std::vector<std::uint16_t>>.read(list, ports);
}
constexpr codec::RowKind kPorts = {.write = codec::kind_of<std::vector<std::uint16_t>>.write,
                                   .read = read_ports,
                                   .schema = codec::kind_of<std::vector<std::uint16_t>>.schema};

codec::Value write_addresses(const void* addresses) {
  codec::Value::Array list;
  for (const std::uint32_t each : *static_cast<const std::vector<std::uint32_t>*>(addresses))
    list.push_back({settings::ipv4_text(each)});
  return {std::move(list)};
}

void read_addresses(const Field& list, void* addresses) {
  auto& all = *static_cast<std::vector<std::uint32_t>*>(addresses);
  const std::size_t count = list.size();
  if (count > kMostEndpoints) list.refuse("expected at most ", kMostEndpoints);
  for (std::size_t i = 0; i < count && !list.reading().has_refusal(); ++i) {
    const Field field = list.element(i);
    const auto address = settings::ipv4_of(field.text());
    if (!address) {
      field.refuse("expected an IPv4 address");
    } else if (!all.empty() && all.back() >= *address) {
      field.refuse("expected ascending addresses, each once");
    } else {
      all.push_back(*address);
    }
  }
}

constexpr codec::Schema kAddressesSchema = {.type = "array"};
constexpr codec::RowKind kAddresses = {
    .write = write_addresses, .read = read_addresses, .schema = &kAddressesSchema};

/// Time within which a change must be confirmed.
template <auto within>
constexpr Member confirm_within() {
  return member<within>("confirm_within_ms").from(kLeastWithin.count()).to(kMostWithin.count());
}

constexpr Member kWantedMembers[] = {
    member<&ChangeRequest::nonce>("nonce").matching(codec::kNonce),
    confirm_within<&ChangeRequest::confirm_within>(),
    member<&ChangeRequest::numbers>("numbers"),
};
constexpr Member kWordMembers[] = {
    member<&Decision::nonce>("nonce").matching(codec::kNonce),
    member<&Decision::what>("word"),
};
constexpr Member kProbeMembers[] = {
    member<&Probe::nonce>("nonce").matching(codec::kNonce),
    member<&Probe::sought>("sought").matching(kAddressOrNone),
};
constexpr Member kEndpointsMembers[] = {member<&Endpoints::addresses>("endpoints").as(kAddresses)};
constexpr Member kForgetMembers[] = {member<&FactoryRequest::nonce>("nonce").matching(codec::kNonce)};
constexpr Member kPortsMembers[] = {member<&TeamPorts::ports>("ports").as(kPorts)};
constexpr Member kPendingMembers[] = {
    member<&Pending::nonce>("nonce").matching(codec::kNonce),
    member<&Pending::until>("until_ms").from(0),
    confirm_within<&Pending::confirm_within>(),
    member<&Pending::wanted>("wanted"),
};
constexpr Member kStatusMembers[] = {
    member<&Status::team_interface>("team_interface"),
    member<&Status::command_post_interface>("command_post_interface"),
    member<&Status::kept>("kept"),
    member<&Status::endpoints, &Endpoints::addresses>("endpoints").as(kAddresses),
    member<&Status::pending>("pending"),
    member<&Status::ended>("last"),
    member<&Status::ended_nonce>("last_nonce"),
    member<&Status::why>("why"),
    member<&Status::trouble>("trouble"),
};
constexpr Member kProbedMembers[] = {
    member<&ProbeResult::nonce>("nonce").matching(codec::kNonce),
    member<&ProbeResult::address>("address"),
    member<&ProbeResult::claimant>("claimant"),
    member<&ProbeResult::own>("own"),
    member<&ProbeResult::found_on>("found_on"),
    member<&ProbeResult::trouble>("trouble"),
    member<&ProbeResult::not_sought>("not_sought"),
};

constexpr Member kTakenAddressMembers[] = {
    member<&AddressConflict::interface>("interface"),
    member<&AddressConflict::address>("address").matching(kAddress),
    member<&AddressConflict::mac>("mac").matching(kMac),
    member<&AddressConflict::seen>("seen_ms").from(0),
};
constexpr Member kTakenMembers[] = {
    member<&AddressConflicts::addresses>("taken").as(kTaken),
    member<&AddressConflicts::exchanged>("exchanged").as(kTaken),
};

/// The file of the stored numbers.
struct NumbersFile {
  Numbers numbers;
  static const Row kRow;
};
constexpr Member kKeptMembers[] = {member<&NumbersFile::numbers>("numbers")};
constexpr Row NumbersFile::kRow = codec::complete<NumbersFile>({"", kKeptMembers});

}  // namespace

constexpr codec::Form kAddressOrNone{
    [](std::string_view text) { return text.empty() || kAddress.fits(text); }, "an IPv4 address, or none"};

constexpr Row ChangeRequest::kRow = codec::complete<ChangeRequest>({"", kWantedMembers});
constexpr Row Decision::kRow = codec::complete<Decision>({"", kWordMembers});
constexpr Row Probe::kRow = codec::complete<Probe>({"", kProbeMembers});
constexpr Row Endpoints::kRow = codec::complete<Endpoints>({"", kEndpointsMembers});
constexpr Row TeamPorts::kRow = codec::complete<TeamPorts>({"", kPortsMembers});
constexpr Row FactoryRequest::kRow = codec::complete<FactoryRequest>({"", kForgetMembers});
constexpr Row Pending::kRow = codec::complete<Pending>({"", kPendingMembers});
constexpr Row Status::kRow = codec::complete<Status>({"", kStatusMembers});
constexpr Row ProbeResult::kRow = codec::complete<ProbeResult>({"", kProbedMembers});
constexpr Row AddressConflict::kRow = codec::complete<AddressConflict>({"", kTakenAddressMembers});
constexpr Row AddressConflicts::kRow = codec::complete<AddressConflicts>({"", kTakenMembers});

std::string rules_for(const TeamPorts& ports) {
  const std::set<std::uint16_t> all(ports.ports.begin(), ports.ports.end());
  std::string rules = "flush set inet adit team_ports\n";
  for (const std::uint16_t port : all)
    rules += icd::sentence("add element inet adit team_ports { ", port, " }\n");
  return rules;
}

std::string write_kept(const Numbers& numbers) {
  return codec::write_file(NumbersFile{numbers});
}

std::expected<Numbers, std::string> read_kept(std::string_view json) {
  auto kept = ADIT_TRY(codec::read_file<NumbersFile>(json));
  return std::move(kept.numbers);
}

}  // namespace adit::network
