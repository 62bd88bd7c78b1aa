// The rows of the box's answers: README.md.

#include <algorithm>

#include "api/box.hpp"
#include "api/certificate.hpp"
#include "api/clock.hpp"
#include "api/keys.hpp"
#include "api/network.hpp"
#include "api/route.hpp"
#include "api/run_view.hpp"
#include "api/self_test.hpp"
#include "api/spare.hpp"
#include "api/updates.hpp"
#include "clock/messages.hpp"
#include "network/messages.hpp"

namespace adit::codec {

/// An object with a member for each field.
template <>
struct KindOf<api::LogFields> {
  static Value write(const api::LogFields& fields) {
    Value::Object object;
    for (const auto& [name, value] : fields) object.emplace_back(name, Value{value});
    return {std::move(object)};
  }
  static void read(const Field& field, api::LogFields& fields) {
    if (!field.is<Value::Object>()) return field.refuse_kind("an object");
    for (const auto& [name, value] : std::get<Value::Object>(field.value()->is))
      fields.emplace_back(name, std::string(field.member(name).text()));
  }
  static constexpr Schema schema = {.type = "object", .more = R"("additionalProperties":{"type":"string"})"};
};

template <>
struct KindOf<access::Role> : WriteOnly {
  static Value write(access::Role role) { return {std::string(name_of(role))}; }
  static constexpr Schema schema = {
      .type = "string", .more = R"("enum":["operator","viewer"])", .name = "Role"};
};

}  // namespace adit::codec

namespace adit::api {
namespace {

using codec::group;
using codec::made_of;
using codec::member;
using codec::Member;
using codec::Row;
using codec::Schema;
using codec::Value;

constexpr std::string_view kLevels[] = {"error", "warning", "notice", "info", "debug"};

constexpr Member kRecord[] = {
    member<&LogRecord::seq>("seq", "number of the record since the start of aditd"),
    member<&LogRecord::at>("at", "seconds since 1970"),
    member<&LogRecord::level>("level").one_of(kLevels),
    member<&LogRecord::message>("message"),
    member<&LogRecord::fields>("fields"),
};

constexpr Member kPage[] = {
    member<&LogPage::last>("last",
                           "number of the last record; if it is less than since, aditd was restarted"),
    member<&LogPage::records>("records"),
};

constexpr Member kPart[] = {
    member<&PartRow::name>("name"),
    member<&PartRow::version>("version"),
    member<&PartRow::licence>("licence", "SPDX"),
};

constexpr Member kBoard[] = {
    member<&BoardRow::name>("name"),
    member<&BoardRow::title>("title"),
};

constexpr Member kAbout[] = {
    member<&About::version>("version"),
    member<&About::build>("build"),
    member<&About::licence>("licence", "SPDX"),
    member<&About::started>("started", "seconds since 1970"),
    member<&About::uptime>("uptime", "seconds"),
    member<&About::kernel>("kernel"),
    member<&About::model>("model", "empty if unknown"),
    member<&About::board>("board", "null if unknown"),
    member<&About::parts>("parts"),
};

constexpr Member kInterface[] = {
    member<&InterfaceRow::name>("name"),
    member<&InterfaceRow::up>("up"),
    member<&InterfaceRow::carrier>("carrier"),
    member<&InterfaceRow::addresses>("addresses"),
};

constexpr Member kRoute[] = {
    member<&RouteRow::destination>("destination"),
    member<&RouteRow::gateway>("gateway"),
    member<&RouteRow::interface>("interface"),
    member<&RouteRow::metric>("metric"),
};

constexpr Member kNetwork[] = {
    member<&NetworkState::interfaces>("interfaces"),
    member<&NetworkState::routes>("routes"),
    member<&NetworkState::trouble>("trouble"),
};

constexpr Member kSession[] = {
    member<&SessionRow::number>("number"),
    member<&SessionRow::role>("role"),
    member<&SessionRow::address>("address"),
    member<&SessionRow::agent>("agent", "User-Agent of the browser"),
    member<&SessionRow::made>("made", "seconds since 1970"),
    member<&SessionRow::seen>("seen", "seconds since 1970"),
    member<&SessionRow::own>("own", "whether this is the client's own session"),
};

constexpr Member kWhoAsks[] = {
    member<&SessionView::role>("role"),
    member<&SessionView::csrf>(
        "csrf", "value of the header Adit-CSRF for requests with the cookie; null without a session")
        .as(codec::kTextOrNull),
    member<&SessionView::first_start>("first_start",
                                      "whether no password is set yet, so that the code sets one"),
    member<&SessionView::set_up_open>("set_up_open",
                                      "whether the operator's password can be set without the present one, "
                                      "because the box's button opened set-up"),
    member<&SessionView::secure>("secure", "whether this request came by HTTPS"),
    member<&SessionView::https>("https", "whether the box offers HTTPS, at port 443"),
};

constexpr std::string_view kTestSteps[] = {"link", "address", "cables", "reach", "token", "clock"};
constexpr std::string_view kTestStates[] = {"waiting", "running", "good", "bad", "skipped"};

constexpr Member kTestStep[] = {
    member<&TestStep::name>("name").one_of(kTestSteps),
    member<&TestStep::state>("state").one_of(kTestStates),
    member<&TestStep::said>("said"),
    member<&TestStep::advice>("advice"),
};

constexpr Member kTestedEndpoint[] = {
    member<&TestedEndpoint::name>("name").one_of(facts::kEndpoints),
    member<&TestedEndpoint::address>("address"),
    member<&TestedEndpoint::steps>("steps"),
};

constexpr Member kTest[] = {
    member<&TestView::number>("number", "counts the tests since aditd started; 0 before the first"),
    member<&TestView::running>("running"),
    member<&TestView::applied>("applied",
                               "whether the settings in use are tested; false for named endpoints"),
    member<&TestView::outdated>("outdated", "whether settings or tokens have changed since the test began"),
    member<&TestView::course>(
        "course", "course whose addresses and tokens are used if none were named; empty for no course"),
    member<&TestView::endpoints>("endpoints"),
};

/// Rejects other members, because a misspelt name would test the wrong values.
void know(const codec::Field& field, std::span<const std::string_view> names) {
  if (!field.is<Value::Object>()) return field.refuse_kind("an object");
  for (const auto& [name, value] : std::get<Value::Object>(field.value()->is)) {
    if (std::ranges::find(names, name) == names.end())
      field.refuse("no such member: ", icd::quote_text(name), "; expected ", codec::list_alternatives(names));
  }
}

Candidate::Endpoint endpoint_in(const codec::Field& field) {
  constexpr std::string_view kKnown[] = {"address", "port", "token"};
  know(field, kKnown);
  Candidate::Endpoint endpoint;
  const codec::Field address = field.member("address"), port = field.member("port"),
                     token = field.member("token");
  if (!address.is_absent()) endpoint.address = address.text();
  if (!port.is_absent()) endpoint.port = port.integer<std::uint16_t>(1);
  if (token.is_absent() || token.is_empty_text()) return endpoint;
  endpoint.token = icd::BearerToken::parse(token.text());
  if (!endpoint.token) token.refuse("expected 1 to 256 visible ASCII characters");
  return endpoint;
}

Candidate candidate_in(const codec::Field& root) {
  constexpr std::string_view kKnown[] = {"course", "scoring", "mapping"};
  know(root, kKnown);
  Candidate candidate;
  const codec::Field course = root.member("course"), scoring = root.member("scoring"),
                     mapping = root.member("mapping");
  if (!course.is_absent()) candidate.course = course.text();
  if (!scoring.is_absent()) candidate.scoring = endpoint_in(scoring);
  if (!mapping.is_absent()) candidate.mapping = endpoint_in(mapping);
  return candidate;
}

constexpr auto kStages = std::span(update::kStageWords).subspan(1);  // without the empty one
constexpr std::string_view kDoing[] = {"receiving", "checking", "installing", "restarting"};

constexpr Member kLastMembers[] = {
    member<&update::LastUpdate::stage>("stage").one_of(kStages),
    member<&update::LastUpdate::version>("version"),
    member<&update::LastUpdate::slot>("slot"),
    member<&update::LastUpdate::why>("why"),
};
constexpr Row kLast = {"", kLastMembers};

/// null without an update.
struct LastOrNull {
  static Value write(const update::LastUpdate& last) {
    return last.stage == update::Stage::None ? Value{} : write_row(kLast, &last);
  }
  static void read(const codec::Field& field, update::LastUpdate& last) {
    if (!field.is_absent()) read_row(kLast, field, &last);
  }
  static constexpr Schema schema = {.row = &kLast, .or_null = true};
};

constexpr Member kUpdate[] = {
    member<&UpdateView::managed>("managed"),
    member<&UpdateView::why>("why", "why the box cannot be updated here"),
    member<&UpdateView::runs_here>("runs_here",
                                   "false: this machine has no adit-update, as a PC with its own updates"),
    member<&UpdateView::status, &update::Status::running, &update::RunningSystem::compatible>("board"),
    member<&UpdateView::status, &update::Status::running, &update::RunningSystem::version>("version"),
    member<&UpdateView::status, &update::Status::running, &update::RunningSystem::slot>("slot",
                                                                                        "running slot"),
    member<&UpdateView::status, &update::Status::running, &update::RunningSystem::other>(
        "other_slot", "slot for the next update"),
    member<&UpdateView::status, &update::Status::trial>(
        "trial", "whether the running version was installed last and has not yet been healthy for a minute"),
    member<&UpdateView::status, &update::Status::stray>("stray", "which unexpected slot is running, and why")
        .as(codec::kTextOrNull),
    member<&UpdateView::status, &update::Status::doing>("doing").as(codec::kTextOrNull).one_of(kDoing),
    member<&UpdateView::status, &update::Status::progress>("progress").from(0).to(100),
    member<&UpdateView::status, &update::Status::refusal>("refusal", "why the last update was not installed")
        .as(codec::kTextOrNull),
    member<&UpdateView::status, &update::Status::last>("last").as(
        codec::kind_as<update::LastUpdate, LastOrNull>),
    member<&UpdateView::status, &update::Status::stick>("stick"),
    member<&UpdateView::status, &update::Status::stick_trouble>(
        "stick_why", "why the update on a stick cannot be installed")
        .as(codec::kTextOrNull),
    member<&UpdateView::newer>(
        "newer", "newer version that apt has; empty: no newer one; null: not known, as without apt"),
    member<&UpdateView::newer_why>("newer_why", "why the newer version cannot be read")
        .as(codec::kTextOrNull),
};

constexpr Member kExportMembers[] = {
    member<&ExportRow::name>("name", "address at which the team used the box that made the export"),
    member<&ExportRow::version>("version", "version of that box"),
    member<&ExportRow::at>("at", "start of that box's standby: seconds since 1970 by its clock"),
    member<&ExportRow::reports>("reports", "number of reports"),
    member<&ExportRow::open>("open", "number of reports that are still open"),
    member<&ExportRow::post>("post", "address and port of the Command Post"),
    member<&ExportRow::run>("run", "the run's last status; null if there was none"),
    member<&ExportRow::port>(
        "port", "first port of that box for the team; this box listens there after the take-over"),
    member<&ExportRow::left_out>("left_out", "settings of that box that are unknown here"),
};

constexpr Member kStickExportMembers[] = {
    member<&StickExportRow::name>("name", "name of the file"),
    member<&StickExportRow::box>(
        "box",
        "address of the box that made the export, from the file's name; empty if the name has no address"),
    member<&StickExportRow::at>(
        "at", "start of that box's standby, from the file's name; null if the name has no time"),
};

constexpr Member kStickMembers[] = {
    member<&StickRow::hindrance>("hindrance", "why no export can be written to the stick, or empty"),
    member<&StickRow::unreadable>("unreadable",
                                  "why the stick cannot be read; empty if it can, or if exports were found"),
    member<&StickRow::doing>("doing", "writing, checking or reading, or empty"),
    member<&StickRow::refusal>("refusal", "why the last action failed, or empty"),
    member<&StickRow::written>("written",
                               "name of this box's export on the stick after it was checked, or empty"),
    member<&StickRow::exports>("exports", "exports on the stick, latest first"),
};

constexpr Member kSpareMembers[] = {
    member<&SpareView::standby>("standby", "whether the box is on standby: it accepts and sends no messages"),
    member<&SpareView::why>("why", "why the box is on standby, or empty"),
    member<&SpareView::since>("since",
                              "start of standby in seconds since 1970; null if the box is not on standby"),
    member<&SpareView::code>(
        "code", "code that opens the box's export, in groups of digits; empty if there is no export"),
    member<&SpareView::asks_code>("asks_code", "whether an imported export needs its code"),
    member<&SpareView::taken_in>("taken_in", "content of the opened export; null if no export is open"),
    member<&SpareView::takes_over>("takes_over", "whether a take-over is in progress"),
    member<&SpareView::stick>("stick", "the stick in the box; null if sticks are not available here"),
};

constexpr Member kCertificateMembers[] = {
    member<&CertificateView::offered>("offered", "whether the box offers HTTPS, at port 443"),
    member<&CertificateView::why>("why", "why the box offers no HTTPS, or empty"),
    member<&CertificateView::fingerprint>(
        "fingerprint", "SHA-256 of the certificate, as browsers show it; empty without a certificate"),
    member<&CertificateView::until>("until", "last day of the certificate: 2036-11-28; or empty"),
};

constexpr Member kClockMembers[] = {
    member<&ClockView::now>("now", "seconds since 1970"),
    member<&ClockView::managed>("managed", "whether the clock can be set here"),
    member<&ClockView::why>("why", "why the clock cannot be set here"),
    member<&ClockView::source>("source", "source that set the clock last since the boot; null if not managed")
        .one_of(clock::kSourceWords),
    member<&ClockView::is_set>("is_set", "whether the time is known well enough"),
    member<&ClockView::refusal>("refusal", "why the last change failed"),
    member<&ClockView::ntp>("ntp",
                            "state of NTP, or why it does not work; empty if the settings have no NTP"),
    member<&ClockView::is_kept>("is_kept",
                                "whether an NTP server keeps the time, so that no user can set it"),
};

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
struct WantedNumbers : codec::KindOf<network::Numbers> {
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
    member<&PendingNetwork::wanted>("").as(codec::kind_as<network::Numbers, WantedNumbers>),
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
        .one_of(std::span(network::kOutcomeWords).subspan(1)),
    member<&NetworkView::last_why>("last_why"),
};

}  // namespace

constexpr Row LogRecord::kRow = codec::complete<LogRecord, 2>({"LogRecord", kRecord});
constexpr Row LogPage::kRow = codec::complete<LogPage>({"Log", kPage});
constexpr Row PartRow::kRow = codec::complete<PartRow>({"", kPart, "A library of the program."});
constexpr Row BoardRow::kRow = codec::complete<BoardRow>({"", kBoard});
constexpr Row About::kRow = codec::complete<About>({"About", kAbout});
constexpr Row InterfaceRow::kRow = codec::complete<InterfaceRow>({"", kInterface});
constexpr Row RouteRow::kRow = codec::complete<RouteRow>({"", kRoute});
constexpr Row NetworkState::kRow = codec::complete<NetworkState>({"", kNetwork});

constexpr Row SessionRow::kRow = codec::complete<SessionRow>({"Session", kSession});
constexpr Row SessionView::kRow = codec::complete<SessionView>({"SessionView", kWhoAsks});

icd::Checked<Candidate> read_candidate(const std::string& body) {
  if (body.empty()) return Candidate{};
  return read_body<Candidate>(body, candidate_in);
}

constexpr Row TestStep::kRow = codec::complete<TestStep>({"", kTestStep});
constexpr Row TestedEndpoint::kRow = codec::complete<TestedEndpoint>({"", kTestedEndpoint});
constexpr Row TestView::kRow = codec::complete<TestView>({"Test", kTest});

constexpr Row UpdateView::kRow = {"Update", kUpdate};

constexpr Row ExportRow::kRow = codec::complete<ExportRow>({"SpareExport", kExportMembers});
constexpr Row StickExportRow::kRow =
    codec::complete<StickExportRow>({"SpareStickExport", kStickExportMembers});
constexpr Row StickRow::kRow = codec::complete<StickRow>({"SpareStick", kStickMembers});
constexpr Row SpareView::kRow = codec::complete<SpareView>({"Spare", kSpareMembers});

constexpr Row CertificateView::kRow = codec::complete<CertificateView>({"Certificate", kCertificateMembers});

constexpr Row ClockView::kRow = codec::complete<ClockView>({"Clock", kClockMembers});

constexpr Row PortRow::kRow = codec::complete<PortRow>({"", kPortMembers});
constexpr Row PendingNetwork::kRow = codec::complete<PendingNetwork>({"", kPendingMembers});
constexpr Row NetworkView::kRow = {"Network", kNetworkMembers};

}  // namespace adit::api
