#include "api/run_view.hpp"

#include "dispatch/report_life.hpp"

namespace adit::api {
namespace {

using codec::Cell;
using codec::member;
using codec::Member;

constexpr std::string_view kWhen = "seconds since 1970";
constexpr std::string_view kKinds[] = {"grid", "cloud", "state", "markers"};
constexpr std::string_view kClouds[] = {"", "whole", "parts"};
constexpr std::string_view kPrecisions[] = {"", "exact", "1mm", "8mm"};
constexpr std::string_view kPatterns[] = {"off",   "on",   "slow", "fast",  "twice",
                                          "flash", "wink", "rush", "digits"};
constexpr std::string_view kSides[] = {"team", "command_post"};

constexpr Member kReport[] = {
    member<&ReportRow::number>("number").csv(1),
    member<&ReportRow::type>("type", "of the artifact, or what the client sent").csv(3),
    member<&ReportRow::position>("position", "null: damage took from the ledger what it said").exact().csv(4),
    member<&ReportRow::sender>("sender").csv(5),
    member<&ReportRow::robot>("robot", "that its sender named; empty: none").csv(16),
    member<&ReportRow::received>("received", kWhen).csv(6, Cell::Time),
    member<&ReportRow::changed>("changed", kWhen).csv(7, Cell::Time),
    member<&ReportRow::state>("state").one_of(dispatch::kStateWords).csv(8),
    member<&ReportRow::status>("status", "the Command Post's; 0: none yet").csv(12, Cell::NotZero),
    member<&ReportRow::report_status>("report_status").csv(13),
    member<&ReportRow::score_change>("score_change").csv(14),
    member<&ReportRow::note>("note").csv(15),
    member<&ReportRow::run>("run").csv(2),
    member<&ReportRow::asking>("asking", "in doubt, and Adit is finding out").csv(9),
    member<&ReportRow::reconciled>("reconciled", "its answer was found out from the run's status").csv(10),
    member<&ReportRow::same_as>(
        "same_as", "the earlier report that it turned out to be, of a held one: that it may be; or 0")
        .csv(11, Cell::NotZero),
};

constexpr Member kStep[] = {
    member<&ReportStep::at>("at", kWhen),
    member<&ReportStep::state>("state"),
    member<&ReportStep::note>("note"),
};

constexpr Member kDetail[] = {
    member<&ReportDetail::row>(""),
    member<&ReportDetail::history>("history", "oldest first"),
    member<&ReportDetail::answer>("answer", "the Command Post's body, byte for byte"),
};

constexpr Member kActivity[] = {
    member<&ActivityRow::kind>("kind").one_of(kKinds),
    member<&ActivityRow::robot>("robot", "empty: merged maps, markers"),
    member<&ActivityRow::accepted>("accepted"),
    member<&ActivityRow::forwarded>("forwarded"),
    member<&ActivityRow::replaced>("replaced"),
    member<&ActivityRow::merged>("merged"),
    member<&ActivityRow::throttled>("throttled"),
    member<&ActivityRow::failed>("failed"),
    member<&ActivityRow::refused_upstream>("refused_upstream"),
    member<&ActivityRow::no_room>("no_room", "refused to the robot, because too much waits"),
    member<&ActivityRow::queued>("queued"),
    member<&ActivityRow::behind_since>("behind_since",
                                       "when the oldest news that the Command Post lacks was accepted, in "
                                       "seconds since 1970; null: it lacks none"),
    member<&ActivityRow::behind>("behind", "for how many seconds it has lacked that; null: it lacks none"),
    member<&ActivityRow::last_accepted>("last_accepted", kWhen),
    member<&ActivityRow::last_forwarded>("last_forwarded", kWhen),
    member<&ActivityRow::age>("age",
                              "seconds since the Command Post took the last one that was posted; null: it "
                              "took none"),
    member<&ActivityRow::last_no_room>("last_no_room", kWhen),
    member<&ActivityRow::bytes_received>("bytes_received", "of the last"),
    member<&ActivityRow::bytes_sent>("bytes_sent", "of the last"),
    member<&ActivityRow::last_status>("last_status", "the Command Post's, to the last try; 0: none came"),
    member<&ActivityRow::last_sentence>("last_sentence", "what it said, or why nothing came"),
    member<&ActivityRow::clouds>("clouds",
                                 "what the last clouds were taken for. whole: the newest says all that those "
                                 "before it said, and replaces them; parts: each arrives; empty: no two of "
                                 "them have waited")
        .one_of(kClouds),
    member<&ActivityRow::precision>("precision",
                                    "how far the last cloud was rounded that the Command Post took "
                                    "(robots[].precision); empty: it took none")
        .one_of(kPrecisions),
    member<&ActivityRow::points_left_out>(
        "points_left_out",
        "of its clouds, because another of their voxel went, or was taken by the Command Post "
        "(robots[].voxel_metres)"),
    member<&ActivityRow::no_valid_point>(
        "no_valid_point",
        "of its clouds, accepted and not sent, for each of their points is NaN or infinite"),
    member<&ActivityRow::invisible>(
        "invisible", "of its markers, forwarded although nobody sees them: the alpha of their color is 0"),
    member<&ActivityRow::arrival>("arrival", "whether it reaches the Command Post")
        .one_of(alarms::kArrivalWords),
    member<&ActivityRow::level>("level", "how well that is").one_of(alarms::kLevelWords),
};

constexpr Member kRefusal[] = {
    member<&RefusalRow::at>("at", kWhen),
    member<&RefusalRow::uri>("uri"),
    member<&RefusalRow::sender>("sender"),
    member<&RefusalRow::status>("status"),
    member<&RefusalRow::sentence>("sentence",
                                  "as its sender got it: of bad parts, one for each of the first ten"),
    member<&RefusalRow::parts>("parts",
                               "how many parts of a state or of markers were refused; the others of it were "
                               "taken, unless all were bad. 0: no parts"),
    member<&RefusalRow::setting>("setting",
                                 "the key of a setting that can prevent this refusal; empty: no setting can"),
};

constexpr Member kEndpoint[] = {
    member<&EndpointRow::name>("name").one_of(kEndpoints),
    member<&EndpointRow::address>("address"),
    member<&EndpointRow::connected>("connected"),
    member<&EndpointRow::trouble>("trouble"),
    member<&EndpointRow::last_status>("last_status", "to the last try; 0: none came"),
    member<&EndpointRow::answer_ms>("answer_ms"),
    member<&EndpointRow::throttled>("throttled", "answers of 429"),
    member<&EndpointRow::foreign>("foreign", "answers that no Command Post gives: pages of HTML, redirects"),
};

constexpr Member kRejected[] = {
    member<&RejectedRow::number>("number").from(1),
    member<&RejectedRow::kind>("kind").one_of(kKinds),
    member<&RejectedRow::robot>("robot", "empty: of several, or of none"),
    member<&RejectedRow::at>("at", "when it was rejected"),
    member<&RejectedRow::status>("status", "the Command Post's"),
    member<&RejectedRow::why>("why"),
    member<&RejectedRow::bytes>("bytes"),
    member<&RejectedRow::replaced>(
        "replaced", "something newer that says all of it was sent since: it is not sent again"),
};

constexpr Member kRobot[] = {
    member<&RobotRow::name>("name"),
    member<&RobotRow::position>("position"),
    member<&RobotRow::heading>("heading", "radians about z"),
    member<&RobotRow::at>("at", "when its last pose was forwarded first"),
    member<&RobotRow::age>("age", "seconds since then"),
};

constexpr Member kLight[] = {
    member<&LightRow::name>("name"),
    member<&LightRow::pattern>("pattern").one_of(kPatterns),
};

constexpr Member kLink[] = {
    member<&LinkRow::side>("side").one_of(kSides),
    member<&LinkRow::interface>("interface"),
    member<&LinkRow::carrier>("carrier", "null: there is no such interface"),
};

constexpr Member kView[] = {
    member<&RunView::now>("now", kWhen),
    member<&RunView::version>("version"),
    member<&RunView::run>("run"),
    member<&RunView::run_heard>("run_heard", kWhen),
    member<&RunView::run_number>("run_number"),
    member<&RunView::run_id>("run_id", "the Command Post's; empty: it names none"),
    member<&RunView::run_seconds>("run_seconds", "that a run lasts, as the settings say"),
    member<&RunView::endpoints>("endpoints"),
    member<&RunView::robots>("robots", "by name"),
    member<&RunView::reports>("reports",
                              "newest first, at most 200: those with which something is still to happen, "
                              "and the newest others"),
    member<&RunView::near_metres>("near_metres",
                                  "of one type and this near, two reports may be of one artifact"),
    member<&RunView::activities>("activities"),
    member<&RunView::refusals>("refusals", "newest first, the last 50"),
    member<&RunView::rejected>("rejected", "what the Command Post would not take, oldest first, at most 100"),
    member<&RunView::lights>("lights"),
    member<&RunView::links>("links", "of the interfaces that the settings name"),
    member<&RunView::identify_until>("identify_until", "the lights flash so that the box can be found"),
    member<&RunView::setup_open_until>(
        "setup_open_until",
        "the box's button opened set-up: a new password can be set without the present one"),
    member<&RunView::budget_mbit>("budget_mbit"),
    member<&RunView::sent_mbit>("sent_mbit", "over the last seconds, to both endpoints"),
    member<&RunView::queued_bytes>("queued_bytes"),
    member<&RunView::map_version>("map_version", "says whether /adit/map has changed"),
    member<&RunView::marker_version>("marker_version", "says whether /adit/markers has changed"),
    member<&RunView::verdict>("verdict"),
    member<&RunView::alarms>("alarms", "bad before ask before wait, then the oldest first"),
    member<&RunView::alarms_over>("alarms_over", "the last few that went, the newest first"),
};

// By what a row of a list is told from the others.
constexpr std::string_view kByNumber[] = {"number"}, kByName[] = {"name"}, kBySide[] = {"side"},
                           kByTraffic[] = {"kind", "robot"}, kByMoment[] = {"at", "uri", "sender"};

}  // namespace

constexpr codec::Row ReportRow::kRow = {"Report", kReport, "", kByNumber};
constexpr codec::Row ReportStep::kRow = {"", kStep};
constexpr codec::Row ReportDetail::kRow = {"ReportDetail", kDetail};
constexpr codec::Row ActivityRow::kRow = {"Activity", kActivity, "The traffic of one robot and kind.",
                                          kByTraffic};
constexpr codec::Row RefusalRow::kRow = {"Refusal", kRefusal, "What was refused to its sender.", kByMoment};
constexpr codec::Row EndpointRow::kRow = {"Endpoint", kEndpoint, "", kByName};
constexpr codec::Row RejectedRow::kRow = {"Rejected", kRejected, "", kByNumber};
constexpr codec::Row RobotRow::kRow = {"Robot", kRobot, "", kByName};
constexpr codec::Row LightRow::kRow = {"Light", kLight, "", kByName};
constexpr codec::Row LinkRow::kRow = {"Link", kLink, "", kBySide};
constexpr codec::Row RunView::kRow = {"RunView", kView, "How all stands."};

}  // namespace adit::api
