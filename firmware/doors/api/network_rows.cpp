#include "api/network.hpp"
#include "network/messages.hpp"

namespace adit::api {
namespace {

using codec::group;
using codec::made_of;
using codec::member;
using codec::Member;
using codec::Row;
using codec::Schema;
using codec::Value;

struct OwnAddress {
  static Value write(const NetworkView& view) {
    return view.team ? network::AddressText::write(view.team->address) : Value{};
  }
  static void read(const codec::Field& field, NetworkView& view) {
    view.team.reset();
    if (!field.is_absent()) network::AddressText::read(field, view.team.emplace().address);
  }
  static constexpr Schema schema = network::AddressText::schema.nullable();
};
struct OwnPrefix {
  static Value write(const NetworkView& view) { return view.team ? codec::json(view.team->prefix) : Value{}; }
  static void read(const codec::Field& field, NetworkView& view) {
    if (view.team) codec::KindOf<std::uint8_t>::read(field, view.team->prefix);
  }
  static constexpr Schema schema = {.type = "integer", .or_null = true};
};

constexpr Member kTeamSideMembers[] = {
    member<&NetworkView::team_interface>("interface"),
    member<&NetworkView::mode>("mode").one_of(network::kModeWords),
    made_of<NetworkView, OwnAddress>("address"),
    made_of<NetworkView, OwnPrefix>("prefix"),
};
constexpr Row kTeamSide = {"TeamSide", kTeamSideMembers};

constexpr Member kCommandPostSideMembers[] = {
    member<&NetworkView::command_post_interface>("interface"),
    member<&NetworkView::command_post>("addresses"),
    member<&NetworkView::gateway>("gateway", "empty if there is no gateway")
        .as(codec::kind_as<std::optional<std::uint32_t>, network::AddressOrNone>),
};
constexpr Row kCommandPostSide = {"CommandPostSide", kCommandPostSideMembers};

/// The numbers as members of PendingNetwork.
struct Wanted : codec::KindOf<network::Numbers> {
  static void read(const codec::Field& field, network::Numbers& numbers) {
    const codec::Field team = field.member("team"), post = field.member("command_post");
    if (!team.is<Value::Object>()) return team.refuse_kind("an object");
    if (!post.is<Value::Object>()) return post.refuse_kind("an object");
    const Value both{Value::Object{{"team", *team.value()}, {"command_post", *post.value()}}};
    codec::KindOf<network::Numbers>::read(codec::Field(both, field.reading()), numbers);
  }
};

constexpr Member kPendingMembers[] = {
    member<&PendingNetwork::until>("until", "seconds since 1970"),
    member<&PendingNetwork::wanted>("").as(codec::kind_as<network::Numbers, Wanted>),
    member<&PendingNetwork::previous>("previous", "addresses to which the box returns"),
    member<&PendingNetwork::page>("page", "address of the page to confirm on"),
};

constexpr std::string_view kPortSides[] = {"team", "command_post"};
constexpr Member kPortMembers[] = {
    member<&PortRow::side>("side").one_of(kPortSides),
    member<&PortRow::interface>("interface"),
    member<&PortRow::mac>("mac", "empty if the interface does not exist"),
    member<&PortRow::addresses>("addresses"),
    member<&PortRow::name>("name", "mDNS name; empty if there is none on this side"),
    member<&PortRow::carrier>("carrier", "null if the interface does not exist"),
    member<&PortRow::mbit>("mbit", "speed of the link; null if unknown").from(0),
    member<&PortRow::duplex>("duplex", "full or half; empty if unknown"),
};

constexpr Member kNetworkMembers[] = {
    member<&NetworkView::now>("now", "the box's time of day in seconds since 1970"),
    member<&NetworkView::managed>("managed"),
    member<&NetworkView::why>("why", "why the addresses cannot be changed here"),
    member<&NetworkView::runs_here>(
        "runs_here", "false: this machine has no adit-network, as a PC that sets its own addresses"),
    group<NetworkView, kTeamSide>("team"),
    group<NetworkView, kCommandPostSide>("command_post"),
    member<&NetworkView::pending>("pending"),
    member<&NetworkView::ports>("ports"),
    member<&NetworkView::last>("last")
        .as(codec::kTextOrNull)
        .one_of(std::span(network::kEndedWords).subspan(1)),
    member<&NetworkView::last_why>("last_why"),
};

}  // namespace

constexpr Row PortRow::kRow = {"", kPortMembers};
constexpr Row PendingNetwork::kRow = {"", kPendingMembers};
constexpr Row NetworkView::kRow = {"Network", kNetworkMembers};

}  // namespace adit::api
