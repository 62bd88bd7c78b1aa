#include "settings/keys.hpp"

#include <algorithm>

#include "icd/require.hpp"

namespace adit::settings {
namespace {

// Names a member of Settings, whether const or not.
// NOLINTNEXTLINE(bugprone-macro-parentheses): parentheses would make it no member
#define MEMBER(path) [](auto& s) -> auto& { return s.path; }

constexpr bool kRequired = true;
constexpr std::uint64_t kMiB = 1u << 20;
constexpr std::string_view kReviews[] = {"off", "duplicates", "all"};  // as dispatch::Review

const Key kKeys[] = {
    {"version", "The layout of this file.", Version{}, kRequired},

    {"command_post.scoring.address", "The scoring endpoint, as posted in the Base Station area (ICD 3).",
     text<MEMBER(command_post.scoring.address)>(Form::Address), kRequired},
    {"command_post.scoring.port", "Its port.", whole<MEMBER(command_post.scoring.port)>(1, 65535), kRequired},
    {"command_post.mapping.address", "The mapping endpoint.",
     text<MEMBER(command_post.mapping.address)>(Form::Address), kRequired},
    {"command_post.mapping.port", "Its port.", whole<MEMBER(command_post.mapping.port)>(1, 65535), kRequired},
    {"command_post.interface",
     "The network interface to the Command Post (darpa0). Nothing else is used to reach it; empty: whichever "
     "the routes say.",
     text<MEMBER(command_post.interface)>(Form::Interface)},
    {"command_post.budget_mbit",
     "Megabits a second for both endpoints together (ICD 3). Maps are paced within it, so that a report "
     "never waits behind one.",
     real<MEMBER(command_post.budget_mbit)>(0.1, 100000)},
    {"command_post.rates.reports_hz", "Artifact reports sent a second, at most (ICD 4.1).",
     real<MEMBER(command_post.rates.reports_hz)>(0.001, 1000)},
    {"command_post.rates.status_hz", "Times a second that the run's status is asked for, at most.",
     real<MEMBER(command_post.rates.status_hz)>(0.001, 1000)},
    {"command_post.rates.map_hz", "Maps sent a second, at most.",
     real<MEMBER(command_post.rates.map_hz)>(0.001, 1000)},
    {"command_post.rates.state_hz", "State updates sent a second, at most; each holds all robots.",
     real<MEMBER(command_post.rates.state_hz)>(0.001, 1000)},
    {"command_post.rates.markers_hz", "Markers updates sent a second, at most.",
     real<MEMBER(command_post.rates.markers_hz)>(0.001, 1000)},
    {"command_post.timeouts.connect_ms", "How long connecting may take.",
     whole<MEMBER(command_post.timeouts.connect)>(100, 60000)},
    {"command_post.timeouts.scoring_answer_ms",
     "How long the scoring endpoint may be silent before a report counts as in doubt.",
     whole<MEMBER(command_post.timeouts.scoring_answer)>(100, 600000)},
    {"command_post.timeouts.mapping_answer_ms",
     "How long the mapping endpoint may be silent before an update is sent again.",
     whole<MEMBER(command_post.timeouts.mapping_answer)>(100, 600000)},
    {"command_post.arrange_clouds",
     "Whether clouds lose the padding in and after their points, and have their points put in another order, "
     "so that they are smaller; no value of a point changes.",
     flag<MEMBER(command_post.arrange_clouds)>()},
    {"command_post.course",
     "The course in use, one of courses[].name, whose endpoints then count; empty: those above.",
     text<MEMBER(command_post.course)>(Form::CourseOrNone)},

    {"courses[].name", "What a course is called: its endpoints are switched to by this name.",
     text<MEMBER(courses.back().name)>(Form::Course), kRequired},
    {"courses[].scoring.address", "Its scoring endpoint.",
     text<MEMBER(courses.back().scoring.address)>(Form::Address), kRequired},
    {"courses[].scoring.port", "Its port.", whole<MEMBER(courses.back().scoring.port)>(1, 65535), kRequired},
    {"courses[].mapping.address", "Its mapping endpoint.",
     text<MEMBER(courses.back().mapping.address)>(Form::Address), kRequired},
    {"courses[].mapping.port", "Its port.", whole<MEMBER(courses.back().mapping.port)>(1, 65535), kRequired},

    {"team.listen[].address",
     "Where the team's robots and stations reach Adit; 0.0.0.0: every address of team.interface.",
     text<MEMBER(team.listen.back().address)>(Form::Address), kRequired},
    {"team.listen[].port", "Its port; 0: any free one.", whole<MEMBER(team.listen.back().port)>(0, 65535),
     kRequired},
    {"team.interface",
     "The network interface to the team (team0). Nothing that comes by another is answered; empty: any.",
     text<MEMBER(team.interface)>(Form::Interface)},
    {"team.require_token",
     "Whether a client must present the team's token or one of the Command Post's; if not, any client of the "
     "team's network is served, except a web page that is neither the box's own nor of team.origins.",
     flag<MEMBER(team.require_token)>()},
    {"team.origins",
     "Origins of web pages, with spaces between them, that may read the run's status and post without a "
     "token, reports included, if team.require_token is off: in any browser of the team's network, whoever "
     "wrote the page. With a token a page of any origin is served.",
     text<MEMBER(team.origins)>(Form::Origins)},
    {"team.connections",
     "Connections of the team at once, at most; a quarter of them, at most 32, is for who has shown no "
     "token.",
     whole<MEMBER(team.connections)>(1, 1024)},
    {"team.connections_per_address",
     "Connections from one address at once, at most, that have shown a token or need none.",
     whole<MEMBER(team.connections_per_address)>(1, 1024)},

    {"robots[].name",
     "A robot's name as it was registered (ICD 2). Where any is given, others are taken too, but told of.",
     text<MEMBER(robots.back().name)>(Form::Robot), kRequired},
    {"robots[].alias", "What that robot calls itself in its maps and states: it goes on under its name.",
     text<MEMBER(robots.back().alias)>(Form::Alias)},
    {"robots[].clouds",
     "What that robot's clouds are. whole: each says all that those before it said, so that the newest "
     "replaces those that wait. parts: each arrives. auto: the newer one replaces the one before it where it "
     "has each of its points.",
     choice<MEMBER(robots.back().clouds)>(lanes::kCloudsWords)},
    {"robots[].precision",
     "How far the coordinates of that robot's clouds may be rounded, so that these are smaller. exact: "
     "not at all. 1mm, 8mm: to steps of that size; a point moves by 1.3 steps at most. auto: as far as what "
     "waits forces it. Clouds stay exact where command_post.arrange_clouds is false.",
     choice<MEMBER(robots.back().precision)>(lanes::kPrecisionWords)},
    {"robots[].voxel_metres",
     "Of that robot's clouds one point of each voxel goes, a cube of so many metres (at least 0.01): the "
     "others are left out, and all where the Command Post has taken one; 0: each is sent. Only for a "
     "Command Post that adds each cloud to those before it. Not for clouds that are whole.",
     real<MEMBER(robots.back().voxel_metres)>(0, 10)},

    {"network.confirm_within_ms",
     "How long a change of the network waits to be confirmed from the new address; then it takes itself "
     "back.",
     whole<MEMBER(network.confirm_within)>(1000, 600000)},
    {"network.allow_overlap",
     "Whether the team's subnet may overlap the Command Post's: Adit works even so, but a robot cannot reach "
     "both.",
     flag<MEMBER(network.allow_overlap)>()},

    {"clock.ntp_server",
     "An NTP server on the team's network that the box takes its time from; empty: none. Only where "
     "adit-clock "
     "sets the clock: not on a PC, which has a time service of its own.",
     text<MEMBER(clock.ntp_server)>(Form::Ipv4OrNone)},
    {"clock.serve_ntp",
     "Whether the box is the NTP server of the team's subnet, once its own time is set. Not on a PC, either.",
     flag<MEMBER(clock.serve_ntp)>()},

    {"reports.answer_within_ms",
     "How long a client waits for the answer to its report, at most; then it is told 503 and that the report "
     "is kept.",
     whole<MEMBER(reports.answer_within)>(100, 600000)},
    {"reports.doubt_for_ms",
     "How late a Command Post may still record what it has read: a report whose answer was lost is sent "
     "again only where the run's status says, this long after, that it was not recorded.",
     whole<MEMBER(reports.doubt_for)>(100, 600000)},
    {"reports.doubt_asks",
     "How often in a row the run's status must say so before such a report is sent again.",
     whole<MEMBER(reports.doubt_asks)>(1, 100)},
    {"reports.review",
     "What is held until the operator lets it go: nothing, near duplicates (see reports.near_metres), or "
     "every report.",
     choice<MEMBER(reports.review)>(kReviews)},
    {"reports.near_metres",
     "A report of the same type within this distance of another of the run is its near duplicate.",
     real<MEMBER(reports.near_metres)>(0, 1000)},

    {"queues.map_bytes", "Maps that may wait, in bytes; above it a map is refused with 429.",
     whole<MEMBER(queues.map_bytes)>(kMiB, 16384 * kMiB)},
    {"queues.merge_bytes", "Points that waiting clouds are merged into, at most, in bytes; 0: never merged.",
     whole<MEMBER(queues.merge_bytes)>(0, 256 * kMiB)},
    {"queues.marker_bytes",
     "Markers that may wait, in bytes; above three quarters of it new ones are refused with 429, above it "
     "also those that replace one that waits.",
     whole<MEMBER(queues.marker_bytes)>(kMiB, 1024 * kMiB)},
    {"queues.markers_per_message", "Markers in one update, at most.",
     whole<MEMBER(queues.markers_per_message)>(1, 100000)},
    {"queues.marker_bytes_per_message",
     "Bytes of markers in one update, at most, unless a single one is larger.",
     whole<MEMBER(queues.marker_bytes_per_message)>(1024, 256 * kMiB)},

    {"runs.length_seconds",
     "How long a run lasts: page, display and adit status count down from it. The Command Post does not "
     "say.",
     whole<MEMBER(runs.length_seconds)>(60, 86400)},
    {"runs.run_bytes",
     "Bytes of one run's map, tracks and plots on the disk, at most: beyond it its earliest pictures go.",
     whole<MEMBER(runs.run_bytes)>(2 * kMiB, 1024 * kMiB)},
    {"runs.all_bytes",
     "The same of all runs, and never more than half of what the disk has for them: beyond it the oldest run "
     "goes, but not the present one, and no report.",
     whole<MEMBER(runs.all_bytes)>(4 * kMiB, 65536 * kMiB)},

    {"alarms.silent_for_ms", "How long a robot may say nothing, at least, before it counts as silent.",
     whole<MEMBER(alarms.silent_for)>(1000, 3600000)},
    {"alarms.silent_times",
     "How many times as long as it lets pass between two messages, as a rule, a robot may say nothing before "
     "it counts as silent.",
     real<MEMBER(alarms.silent_times)>(1, 1000)},

    {"rules.rewrite_frame_id", "Take any frame_id and send \"darpa\"; if not, others are refused with 422.",
     flag<MEMBER(rules.rewrite_frame_id)>()},
    {"rules.forward_unknown_types",
     "Send artifact types that are none of the ICD's ten; if not, they are refused with 422.",
     flag<MEMBER(rules.forward_unknown_types)>()},
    {"rules.map_bytes", "The largest data of one map once inflated, in bytes; above it 413.",
     whole<MEMBER(rules.map_bytes)>(1024, icd::kMostMapBytes)},

    {"panel.chip",
     "The GPIO chip of the lights and the button (gpiochip0), by name, label or path; empty: whichever has a "
     "line of that name.",
     text<MEMBER(panel.chip)>(Form::Chip)},
    {"panel.health",
     "The line of the health light; empty: there is none. Without any line: a simulated panel.",
     text<MEMBER(panel.health)>(Form::Line)},
    {"panel.scoring", "The line of the scoring light.", text<MEMBER(panel.scoring)>(Form::Line)},
    {"panel.mapping", "The line of the mapping light.", text<MEMBER(panel.mapping)>(Form::Line)},
    {"panel.attention", "The line of the attention light.", text<MEMBER(panel.attention)>(Form::Line)},
    {"panel.active_low", "Whether a light is lit by driving its line low.", flag<MEMBER(panel.active_low)>()},
    {"panel.button", "The line of the button; empty: there is none.", text<MEMBER(panel.button)>(Form::Line)},
    {"panel.button_active_low", "Whether the button pulls its line low when it is pressed.",
     flag<MEMBER(panel.button_active_low)>()},
};

#undef MEMBER

template <auto member>
constexpr List list(std::string_view path, std::size_t least, std::size_t most) {
  return {path, least, most, [](const Settings& s) { return member(s).size(); },
          [](Settings& s, std::size_t size) { member(s).resize(size); }};
}

const List kLists[] = {
    list<[](auto& s) -> auto& { return s.courses; }>("courses", 0, 16),
    list<[](auto& s) -> auto& { return s.team.listen; }>("team.listen", 1, 16),
    list<[](auto& s) -> auto& { return s.robots; }>("robots", 0, 32),
};

}  // namespace

std::span<const Key> keys() {
  return kKeys;
}

const List& list_at(std::string_view path) {
  const List* const found = std::ranges::find(kLists, path, &List::path);
  icd::require(found != std::end(kLists));
  return *found;
}

Settings with_an_item_of_each() {
  Settings settings;
  for (const List& list : kLists) list.resize(settings, 1);
  return settings;
}

std::vector<Child> children_of(std::string_view prefix) {
  std::vector<Child> children;
  for (const Key& key : keys()) {
    if (!key.path.starts_with(prefix)) continue;
    const std::string_view rest = key.path.substr(prefix.size());
    const std::string_view name = rest.substr(0, rest.find_first_of(".["));
    if (!children.empty() && children.back().name == name) continue;
    children.push_back(
        {name, rest == name ? &key : nullptr, rest.size() > name.size() && rest[name.size()] == '['});
  }
  return children;
}

}  // namespace adit::settings
