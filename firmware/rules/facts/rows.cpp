#include "facts/rows.hpp"

#include <algorithm>

#include "dispatch/report.hpp"

namespace adit::facts {
namespace {

using codec::Cell;
using codec::member;
using codec::Member;

constexpr std::string_view kWhen = "seconds since 1970";
constexpr std::string_view kClouds[] = {"", "whole", "parts"};
constexpr std::string_view kPrecisions[] = {"", "exact", "1mm", "8mm"};
constexpr std::string_view kSides[] = {"team", "command_post"};

constexpr Member kReport[] = {
    member<&ReportRow::number>("number").csv(1),
    member<&ReportRow::type>("type", "type of the artifact, or the text that the client sent").csv(3),
    member<&ReportRow::position>("position", "null if damage of the ledger lost it").exact().csv(4),
    member<&ReportRow::sender>("sender").csv(5),
    member<&ReportRow::robot>("robot", "the robot that the sender named, or empty").csv(16),
    member<&ReportRow::received>("received", kWhen).csv(6, Cell::Time),
    member<&ReportRow::changed>("changed", kWhen).csv(7, Cell::Time),
    member<&ReportRow::state>("state").one_of(dispatch::kStateWords).csv(8),
    member<&ReportRow::status>("status", "status of the Command Post's answer, or 0").csv(12, Cell::NotZero),
    member<&ReportRow::report_status>("report_status").csv(13),
    member<&ReportRow::score_change>("score_change").csv(14),
    member<&ReportRow::note>("note").csv(15),
    member<&ReportRow::run>("run").csv(2),
    member<&ReportRow::asking>("asking", "whether the report is in doubt and Adit is finding out its outcome")
        .csv(9),
    member<&ReportRow::reconciled>("reconciled", "whether the answer was derived from the run's status")
        .csv(10),
    member<&ReportRow::same_as>("same_as",
                                "number of the earlier report that this report repeats (if held: may "
                                "repeat), of the later report that "
                                "corrects it, or 0")
        .csv(11, Cell::NotZero),
    member<&ReportRow::sends_at>("sends_at",
                                 "when this held report is sent, in seconds since 1970, unless the operator "
                                 "withdraws it before; null if "
                                 "the operator decides"),
};

constexpr Member kActivity[] = {
    member<&ActivityRow::kind>("kind").one_of(kKinds),
    member<&ActivityRow::robot>("robot", "empty for merged maps and markers"),
    member<&ActivityRow::accepted>("accepted"),
    member<&ActivityRow::forwarded>("forwarded"),
    member<&ActivityRow::replaced>("replaced"),
    member<&ActivityRow::merged>("merged"),
    member<&ActivityRow::throttled>("throttled"),
    member<&ActivityRow::failed>("failed"),
    member<&ActivityRow::refused_upstream>("refused_upstream"),
    member<&ActivityRow::no_room>("no_room", "rejected because the queue is full"),
    member<&ActivityRow::queued>("queued"),
    member<&ActivityRow::behind_since>(
        "behind_since",
        "when the oldest undelivered update was accepted, in seconds since 1970; null if all are delivered"),
    member<&ActivityRow::age>("age", "seconds since behind_since; null if all are delivered"),
    member<&ActivityRow::last_accepted>("last_accepted", kWhen),
    member<&ActivityRow::last_forwarded>("last_forwarded", kWhen),
    member<&ActivityRow::heard>("heard", "seconds since last_accepted, or null"),
    member<&ActivityRow::last_no_room>("last_no_room", kWhen),
    member<&ActivityRow::bytes_received>("bytes_received", "size of the last accepted update"),
    member<&ActivityRow::bytes_sent>("bytes_sent", "size of the last delivered update"),
    member<&ActivityRow::last_status>(
        "last_status", "status of the Command Post's answer to the last try; 0 if there was no answer"),
    member<&ActivityRow::last_sentence>("last_sentence", "the answer's sentence, or why there was no answer"),
    member<&ActivityRow::clouds>("clouds",
                                 "whole: the newest cloud contains the earlier ones and replaces them. "
                                 "parts: each cloud is delivered. empty: no two clouds were queued yet")
        .one_of(kClouds),
    member<&ActivityRow::precision>("precision",
                                    "rounding of the last delivered cloud (robots[].precision), or empty")
        .one_of(kPrecisions),
    member<&ActivityRow::no_valid_point>(
        "no_valid_point", "clouds accepted but not sent because all of their points are NaN or infinite"),
    member<&ActivityRow::invisible>("invisible",
                                    "markers forwarded with an alpha of 0, which makes them invisible"),
    member<&ActivityRow::arrival>("arrival", "whether updates reach the Command Post").one_of(kArrivalWords),
    member<&ActivityRow::level>("level", "severity of arrival").one_of(kLevelWords),
    member<&ActivityRow::word>("word", "arrival as text; if late, how far behind"),
};

constexpr Member kStanding[] = {
    member<&StandingRow::name>("name"),
    member<&StandingRow::level>("level", "of the worst activity").one_of(kLevelWords),
    member<&StandingRow::word>("word", "of that activity"),
    member<&StandingRow::silent>("silent", "whether the robot is silent for longer than usual"),
    member<&StandingRow::has_map>("has_map", "whether the robot sends maps"),
    member<&StandingRow::age>(
        "age",
        "seconds since the oldest undelivered update of its maps, or else of its poses, "
        "was accepted; null if all are delivered"),
    member<&StandingRow::heard>("heard", "seconds since its last message was accepted, or null"),
};

constexpr Member kRefusal[] = {
    member<&RefusalRow::at>("at", kWhen),
    member<&RefusalRow::uri>("uri"),
    member<&RefusalRow::sender>("sender"),
    member<&RefusalRow::status>("status"),
    member<&RefusalRow::sentence>(
        "sentence", "the sentence for the sender; for wrong parts, one for each of the first ten"),
    member<&RefusalRow::parts>("parts",
                               "number of rejected parts of a state or of markers; the other parts were "
                               "accepted. 0 if the message has no parts"),
    member<&RefusalRow::setting>("setting",
                                 "the key of a setting that can prevent this refusal; empty: no setting can"),
};

constexpr Member kEndpoint[] = {
    member<&EndpointRow::name>("name").one_of(kEndpoints),
    member<&EndpointRow::address>("address"),
    member<&EndpointRow::connected>("connected"),
    member<&EndpointRow::trouble>("trouble"),
    member<&EndpointRow::last_status>("last_status",
                                      "status of the answer to the last try; 0 if there was no answer"),
    member<&EndpointRow::answer_ms>("answer_ms", "from the first byte of a request until its last answer"),
    member<&EndpointRow::answered>("answered", "seconds since that answer; null before the first one"),
    member<&EndpointRow::throttled>("throttled", "number of answers of 429"),
    member<&EndpointRow::foreign>(
        "foreign", "number of answers that are not from a Command Post: pages of HTML, redirects"),
    member<&EndpointRow::level>("level", "bad only with an alarm").one_of(kLevelWords),
    member<&EndpointRow::word>("word", "how the endpoint answers, in few words"),
};

constexpr Member kRejected[] = {
    member<&RejectedRow::number>("number").from(1),
    member<&RejectedRow::kind>("kind").one_of(kKinds),
    member<&RejectedRow::robot>("robot",
                                "the robot; empty if the message is of several robots or has no robot"),
    member<&RejectedRow::at>("at", "when the message was rejected"),
    member<&RejectedRow::status>("status",
                                 "status of the Command Post's answer; 0: aditd put the map aside, because "
                                 "faults ended it while it packed the map"),
    member<&RejectedRow::why>("why"),
    member<&RejectedRow::bytes>("bytes"),
    member<&RejectedRow::replaced>(
        "replaced",
        "whether a newer message that contains all of this one was sent since: it cannot be sent again"),
};

constexpr Member kRobot[] = {
    member<&RobotRow::name>("name"),
    member<&RobotRow::position>("position"),
    member<&RobotRow::heading>("heading", "radians about z"),
    member<&RobotRow::at>("at", "when the robot posted its last pose; null: before a start of the box"),
    member<&RobotRow::age>("age", "seconds since at; null if at is"),
};

constexpr Member kLink[] = {
    member<&LinkRow::side>("side").one_of(kSides),
    member<&LinkRow::interface>("interface"),
    member<&LinkRow::carrier>("carrier", "null if the interface does not exist"),
};

// Keys of the rows in lists.
constexpr std::string_view kByNumber[] = {"number"}, kByName[] = {"name"}, kBySide[] = {"side"},
                           kByTraffic[] = {"kind", "robot"}, kByMoment[] = {"at", "uri", "sender"};

}  // namespace

constexpr codec::Row ReportRow::kRow = codec::complete<ReportRow>({"Report", kReport, "", kByNumber});
constexpr codec::Row ActivityRow::kRow =
    codec::complete<ActivityRow>({"Activity", kActivity, "The traffic of one robot and kind.", kByTraffic});
constexpr codec::Row StandingRow::kRow = codec::complete<StandingRow>({"Standing", kStanding, "", kByName});
constexpr codec::Row RefusalRow::kRow =
    codec::complete<RefusalRow>({"Refusal", kRefusal, "A rejected message.", kByMoment});
constexpr codec::Row EndpointRow::kRow =
    codec::complete<EndpointRow, 5>({"Endpoint", kEndpoint, "", kByName});
constexpr codec::Row RejectedRow::kRow = codec::complete<RejectedRow>({"Rejected", kRejected, "", kByNumber});
constexpr codec::Row RobotRow::kRow = codec::complete<RobotRow>({"Robot", kRobot, "", kByName});
constexpr codec::Row LinkRow::kRow = codec::complete<LinkRow>({"Link", kLink, "", kBySide});

double seconds_since(Time at, Time now) {
  return std::max(0.0, now - at);
}

void set_ages(ActivityRow& row, Time now) {
  const auto since = [now](const std::optional<Time>& at) {
    return at ? std::optional(seconds_since(*at, now)) : std::nullopt;
  };
  row.age = since(row.behind_since);
  row.heard = since(row.last_accepted);
}

}  // namespace adit::facts
