#include "api/run_view.hpp"

namespace adit::api {
namespace {

using codec::member;
using codec::Member;

constexpr std::string_view kWhen = "seconds since 1970";
constexpr std::string_view kPatterns[] = {"off",   "on",   "slow", "fast",  "twice",
                                          "flash", "wink", "rush", "digits"};

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

constexpr Member kColour[] = {
    member<&ColourRow::name>("name"),
    member<&ColourRow::colour>("colour", "number of the colour among those of robots[].colour, from 1")
        .from(1),
};

constexpr Member kLight[] = {
    member<&LightRow::name>("name"),
    member<&LightRow::pattern>("pattern").one_of(kPatterns),
};

constexpr Member kView[] = {
    member<&RunView::now>("now", kWhen),
    member<&RunView::version>("version"),
    member<&RunView::run>("run"),
    member<&RunView::run_clock>("run_clock", "null if there is no status"),
    member<&RunView::run_number>("run_number"),
    member<&RunView::run_id>("run_id", "the Command Post's name of the run, or empty"),
    member<&RunView::run_seconds>("run_seconds", "length of a run, from the settings"),
    member<&RunView::endpoints>("endpoints"),
    member<&RunView::robots>("robots", "by name"),
    member<&RunView::reports>("reports",
                              "newest first, at most 200: the newest open reports, then the newest of the "
                              "others"),
    member<&RunView::near_metres>("near_metres",
                                  "two reports of one type that are this near may be of one artifact"),
    member<&RunView::activities>("activities", "by kind, then by robot"),
    member<&RunView::standings>("standings", "how each robot's data arrive, by name"),
    member<&RunView::colours>("colours", "the colours that the settings give robots"),
    member<&RunView::refusals>("refusals", "the last 50, newest first"),
    member<&RunView::rejected>("rejected", "rejected messages, oldest first, at most 100"),
    member<&RunView::lights>("lights"),
    member<&RunView::links>("links", "the interfaces of the settings"),
    member<&RunView::certificate>("certificate",
                                  "SHA-256 of the certificate for HTTPS; empty if HTTPS is not offered"),
    member<&RunView::identify_until>("identify_until", "end of the flashing that identifies the box"),
    member<&RunView::setup_open_until>("setup_open_until",
                                       "end of the time in which a new password can be set without the "
                                       "present one, opened by the box's button"),
    member<&RunView::budget_mbit>("budget_mbit"),
    member<&RunView::sent_mbit>("sent_mbit", "rate to both endpoints over the last seconds"),
    member<&RunView::queued_bytes>("queued_bytes"),
    member<&RunView::map_version>("map_version", "changes when /adit/map changes"),
    member<&RunView::marker_version>("marker_version", "changes when /adit/markers changes"),
    member<&RunView::verdict>("verdict"),
    member<&RunView::alarms>("alarms", "bad before ask before wait, then the oldest first"),
    member<&RunView::alarms_over>("alarms_over", "the last few ended alarms, newest first"),
};

// Key of the rows in lists.
constexpr std::string_view kByName[] = {"name"};

}  // namespace

constexpr codec::Row ReportStep::kRow = codec::complete<ReportStep>({"", kStep});
constexpr codec::Row ReportDetail::kRow = codec::complete<ReportDetail>({"ReportDetail", kDetail});
constexpr codec::Row ColourRow::kRow = codec::complete<ColourRow>({"RobotColour", kColour, "", kByName});
constexpr codec::Row LightRow::kRow = codec::complete<LightRow>({"Light", kLight, "", kByName});
constexpr codec::Row RunView::kRow =
    codec::complete<RunView>({"RunView", kView, "The present state of the run."});

}  // namespace adit::api
