#include "network/numbers.hpp"

namespace adit::network {
namespace {

using codec::group;
using codec::made_of;
using codec::member;
using codec::Member;
using codec::Row;
using codec::Schema;
using codec::Value;
using settings::Subnet;

constexpr Member kHostMembers[] = {
    member<&Subnet::address>("address").as(codec::kind_as<std::uint32_t, AddressText>),
    member<&Subnet::prefix>("prefix"),
};

struct StaticAddress : codec::WriteOnly {
  static Value write(const Numbers& numbers) {
    return numbers.mode == Mode::Static ? AddressText::write(numbers.team.address) : Value{};
  }
  static constexpr Schema schema = AddressText::schema;
};
struct StaticPrefix : codec::WriteOnly {
  static Value write(const Numbers& numbers) {
    return numbers.mode == Mode::Static ? codec::json(numbers.team.prefix) : Value{};
  }
  static constexpr Schema schema = {.type = "integer"};
};
struct Hosts : codec::KindOf<std::vector<Subnet>> {
  static constexpr Schema schema = {
      .type = "array", .items = &codec::KindOf<Subnet>::schema, .most = kMostAddresses};
};

constexpr Member kTeamMembers[] = {
    member<&Numbers::mode>("mode").one_of(kModeWords),
    made_of<Numbers, StaticAddress>("address").optional(),
    made_of<Numbers, StaticPrefix>("prefix").optional(),
};
constexpr Row kTeam = {"TeamNumbers", kTeamMembers, "Has an address only if mode is static."};

constexpr Member kCommandPostMembers[] = {
    member<&Numbers::command_post>("addresses").as(codec::kind_as<std::vector<Subnet>, Hosts>),
    member<&Numbers::gateway>("gateway", "empty if there is no gateway")
        .as(codec::kind_as<std::optional<std::uint32_t>, AddressOrNone>),
};
constexpr Row kCommandPost = {"CommandPostNumbers", kCommandPostMembers};

constexpr Member kNumbersMembers[] = {group<Numbers, kTeam>("team"),
                                      group<Numbers, kCommandPost>("command_post")};

}  // namespace

void AddressText::read(const codec::Field& field, std::uint32_t& address) {
  const auto read = settings::ipv4_of(field.text());
  if (!read) field.refuse("expected an IPv4 address");
  address = read.value_or(0);
}

void AddressOrNone::read(const codec::Field& field, std::optional<std::uint32_t>& address) {
  address.reset();
  if (!field.text().empty()) AddressText::read(field, address.emplace());
}

constexpr Row kHost = {"Host", kHostMembers};
constexpr Row Numbers::kRow = {"Numbers", kNumbersMembers};

}  // namespace adit::network
