#include "alarms/conditions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "alarms/kinds.hpp"
#include "icd/sentence.hpp"

namespace adit::alarms {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using enum Severity;

/// A snapshot that makes a condition true while all others are false.
struct ConditionCase {
  const char* id;
  Severity severity;
  Side side;
  const char* what;
  const char* why;  // a part of it
  void (*make)(Snapshot&);
};

void down(Snapshot& snapshot, EndpointFault trouble, std::size_t endpoint) {
  snapshot.traffic.endpoints[endpoint].fault = trouble;
  snapshot.traffic.endpoints[endpoint].since = kNow - 20;
  snapshot.traffic.endpoints[endpoint].said = "Connection refused";
}

template <EndpointFault trouble>
void both_down(Snapshot& snapshot) {
  down(snapshot, trouble, 0);
  down(snapshot, trouble, 1);
}

void report(Snapshot& snapshot, const char* state) {
  add_report(snapshot, {.number = 7, .changed = kNow - 5, .state = state, .note = "it may be the same"});
}

void lose_report(Snapshot& snapshot) {
  report(snapshot, "in_doubt");
  snapshot.reports.rows[0].position.reset();
}

/// Messages that the Command Post rejected, and some that call nobody.
void reject(Snapshot& snapshot, std::uint64_t count) {
  for (std::uint64_t number = 1; number <= count; ++number) {
    snapshot.reports.rejected.push_back(
        {.number = number, .kind = "cloud", .robot = "ugv1", .status = 413, .why = "too large (3021 kB)"});
  }
  snapshot.reports.rejected.push_back({.number = 900, .status = 413, .replaced = true});
  snapshot.reports.rejected.push_back({.number = 901, .status = 0});
}

const ConditionCase kConditionCases[] = {
    {"command_post_unreachable", Bad, Side::CommandPost, "Command Post is unreachable", "Connection refused",
     both_down<EndpointFault::Unreachable>},
    {"command_post_silent", Bad, Side::CommandPost, "Command Post is silent", "10.100.1.200:8000 and",
     both_down<EndpointFault::Silent>},
    {"command_post_refusing", Bad, Side::CommandPost, "Both tokens are rejected", "is the course right?",
     both_down<EndpointFault::Refusing>},
    {"command_post_refusing", Bad, Side::CommandPost, "The scoring token is rejected", "is the course right?",
     [](Snapshot& snapshot) { down(snapshot, EndpointFault::Refusing, 0); }},
    {"command_post_refusing", Bad, Side::CommandPost, "The mapping token is rejected", "know uav1?",
     [](Snapshot& snapshot) {
       down(snapshot, EndpointFault::Refusing, 1);
       std::erase_if(snapshot.traffic.activities,
                     [](const ActivityRow& stream) { return stream.robot != "uav1"; });
     }},
    {"command_post_foreign", Bad, Side::CommandPost, "The server is not a Command Post", "(mapping)",
     [](Snapshot& snapshot) { down(snapshot, EndpointFault::Foreign, 1); }},
    {"command_post_failing", Bad, Side::CommandPost, "Mapping is failing", "every request",
     [](Snapshot& snapshot) { down(snapshot, EndpointFault::Failing, 1); }},
    {"command_post_throttling", Wait, Side::CommandPost, "Mapping is throttling", "429",
     [](Snapshot& snapshot) { down(snapshot, EndpointFault::Throttling, 1); }},
    {"no_token:scoring", Bad, Side::Box, "The scoring token is missing", "reports stay queued",
     [](Snapshot& snapshot) { down(snapshot, EndpointFault::NoToken, 0); }},
    {"no_token:mapping", Bad, Side::Box, "The mapping token is missing",
     "maps, states and markers stay queued",
     [](Snapshot& snapshot) { down(snapshot, EndpointFault::NoToken, 1); }},
    {"no_token:team", Bad, Side::Box, "The team token is missing", "rejects every robot",
     [](Snapshot& snapshot) { snapshot.clients.shut_out = true; }},
    {"robot_silent:uav2", Bad, Side::Robot, "uav2 is silent", "a message every 2 s",
     [](Snapshot& snapshot) { snapshot.traffic.habits["uav2"] = {.gap = 2, .quiet = 94, .silent = true}; }},
    {"map_behind:uav1", Wait, Side::CommandPost, "uav1's map is behind", "grid",
     [](Snapshot& snapshot) { snapshot.traffic.activities[0].age = 21; }},
    {"map_behind:uav1", Bad, Side::CommandPost, "uav1's map is behind", "grid",
     [](Snapshot& snapshot) { snapshot.traffic.activities[0].age = 91; }},
    {"queue_growing", Wait, Side::Network, "The map queue is growing", "0 MB are queued",
     [](Snapshot& snapshot) { snapshot.traffic.queue_grows = true; }},
    {"queue_nearly_full", Bad, Side::Network, "The map queue is nearly full", "104 MB",
     [](Snapshot& snapshot) { snapshot.traffic.queued = 81u << 20; }},
    {"queue_full", Bad, Side::Network, "The queue is full", "uav1 grid",
     [](Snapshot& snapshot) { snapshot.traffic.activities[0].last_no_room = kNow - 59; }},
    {"robot_unknown:uav9", Ask, Side::Robot, "Robot uav9 is unknown", "only uav1, uav2",
     [](Snapshot& snapshot) {
       snapshot.clients.unknown_robots = {"uav9"};
       snapshot.traffic.registered = {"uav1", "uav2"};
     }},
    {"clients_refused", Bad, Side::Robot, "Clients are rejected", "10.0.0.9",
     [](Snapshot& snapshot) { snapshot.clients.crowds = {{Crowd::Kind::NoRoom, "10.0.0.9"}}; }},
    {"wrong_tokens", Ask, Side::Robot, "Wrong tokens are in use", "10.0.0.9",
     [](Snapshot& snapshot) { snapshot.clients.crowds = {{Crowd::Kind::WrongToken, "10.0.0.9"}}; }},
    {"client_token", Wait, Side::Robot, "A client is without a token", "10.0.0.9",
     [](Snapshot& snapshot) { snapshot.clients.crowds = {{Crowd::Kind::NoToken, "10.0.0.9"}}; }},
    {"unauthenticated", Wait, Side::Robot, "Too many clients are anonymous", "10.0.0.9",
     [](Snapshot& snapshot) { snapshot.clients.crowds = {{Crowd::Kind::Unauthenticated, "10.0.0.9"}}; }},
    {"report_held:7", Ask, Side::CommandPost, "Report 7 is held", "it may be the same",
     [](Snapshot& snapshot) { report(snapshot, "held"); }},
    {"report_in_doubt:7", Ask, Side::CommandPost, "Report 7 is in doubt", "",
     [](Snapshot& snapshot) { report(snapshot, "in_doubt"); }},
    {"report_lost:7", Ask, Side::CommandPost, "Report 7 is lost", "Settle report 7: it may be the same",
     [](Snapshot& snapshot) {
       lose_report(snapshot);
       snapshot.reports.rows.push_back({.number = 6});
     }},
    {"report_lost:7", Ask, Side::CommandPost, "Reports are possibly missing",
     "Settle report 7: it may be the same", lose_report},
    {"report_lost:7", Ask, Side::CommandPost, "Reports are possibly missing",
     "new reports are held until you Settle report 7",
     [](Snapshot& snapshot) {
       lose_report(snapshot);
       snapshot.reports.lost_here = {7};
     }},
    {"reports_left", Wait, Side::CommandPost, "5 reports are left", "",
     [](Snapshot& snapshot) { snapshot.reports.left = 5; }},
    {"reports_left", Wait, Side::CommandPost, "1 report is left", "",
     [](Snapshot& snapshot) { snapshot.reports.left = 1; }},
    {"reports_left", Bad, Side::CommandPost, "No reports are left", "",
     [](Snapshot& snapshot) { snapshot.reports.left = 0; }},
    {"reports_elsewhere:10.9.9.9:1", Ask, Side::CommandPost, "2 reports are for another server", "10.9.9.9:1",
     [](Snapshot& snapshot) { snapshot.reports.elsewhere["10.9.9.9:1"] = 2; }},
    {"run_unreliable", Ask, Side::CommandPost, "The count of reports is uncertain", "somebody else",
     [](Snapshot& snapshot) { snapshot.reports.run_unreliable = "somebody else reports"; }},
    {"run_renamed", Ask, Side::CommandPost, "The name of the run is uncertain", "calls it run 2",
     [](Snapshot& snapshot) { snapshot.reports.run_renamed = "the Command Post calls it run 2, it was 1"; }},
    {"messages_rejected", Ask, Side::CommandPost, "3 messages are rejected",
     "the newest: ugv1's cloud: too large (3021 kB)", [](Snapshot& snapshot) { reject(snapshot, 3); }},
    {"standby", Bad, Side::Box, "This box is on standby", "for its spare",
     [](Snapshot& snapshot) { snapshot.box.standby = "put on standby for its spare to take over"; }},
    {"ledger_unwritable", Bad, Side::Box, "Reports are not accepted", "cannot write the ledger: no space",
     [](Snapshot& snapshot) { snapshot.box.ledger_refusal = "no space"; }},
    {"ledger_unwritable", Bad, Side::Box, "Reports are not accepted", "or run adit ledger new: I/O error",
     [](Snapshot& snapshot) {
       snapshot.box.ledger_refusal = "I/O error", snapshot.box.ledger_is_closed = true;
     }},
    {"ledger_damaged", Ask, Side::Box, "The ledger is damaged", "a page",
     [](Snapshot& snapshot) { snapshot.box.ledger_damage = "a page was put aside"; }},
    {"other_ledger", Ask, Side::Box, "An earlier ledger is not read", "/var/lib/adit/ledger.sqlite",
     [](Snapshot& snapshot) { snapshot.box.other_ledger = "/var/lib/adit/ledger.sqlite"; }},
    {"queue_put_aside", Ask, Side::Box, "Queued messages are put aside", "3 times",
     [](Snapshot& snapshot) { snapshot.box.put_aside = "the service ended 3 times"; }},
    {"map_not_kept", Bad, Side::Box, "The last map is not accepted", "no space",
     [](Snapshot& snapshot) { snapshot.box.disk.map = "no space"; }},
    {"state_not_kept", Bad, Side::Box, "States and markers are rejected", "cannot store them: no space",
     [](Snapshot& snapshot) { snapshot.box.disk.state = "no space"; }},
    {"run_not_kept", Bad, Side::Box, "The run's map is not stored", "a restart would lose it: no space",
     [](Snapshot& snapshot) { snapshot.box.disk.run = "no space"; }},
    {"disk_full", Bad, Side::Box, "The disk is nearly full", "512 kB",
     [](Snapshot& snapshot) { snapshot.box.disk.free = 500u << 10; }},
    {"disk_full", Bad, Side::Box, "The disk is full", "no space is left for reports",
     [](Snapshot& snapshot) { snapshot.box.disk.free = 0; }},
    {"disk_full", Bad, Side::Box, "The disk is full",
     "the run's map is not stored, so a restart would lose it: no space",
     [](Snapshot& snapshot) { snapshot.box.disk.free = 0, snapshot.box.disk.run = "no space"; }},
    {"ledger_unwritable", Bad, Side::Box, "Reports are not accepted",
     "the disk is full; the box cannot write the ledger: no space",
     [](Snapshot& snapshot) { snapshot.box.disk.free = 0, snapshot.box.ledger_refusal = "no space"; }},
    {"disk_health", Ask, Side::Box, "The disk is nearly worn out", "90 % of its life",
     [](Snapshot& snapshot) { snapshot.box.disk.life = 10; }},
    {"disk_health", Ask, Side::Box, "The disk is nearly worn out", "its expected life is over",
     [](Snapshot& snapshot) { snapshot.box.disk.life = 11, snapshot.box.disk.spares = 3; }},
    {"disk_health", Ask, Side::Box, "The disk is nearly worn out", "80 % of its spare blocks",
     [](Snapshot& snapshot) { snapshot.box.disk.life = 9, snapshot.box.disk.spares = 2; }},
    {"disk_health", Wait, Side::Box, "The disk's health is unknown", "life_time: Input/output error",
     [](Snapshot& snapshot) { snapshot.box.disk.wear_unknown = "life_time: Input/output error"; }},
    {"time_not_set", Wait, Side::Box, "The time of day is not set", "adit clock set",
     [](Snapshot& snapshot) { snapshot.box.time_set = false; }},
    {"stamps", Ask, Side::Box, "Time stamps are ahead", "by 3 days; a factory reset",
     [](Snapshot& snapshot) { snapshot.box.stamps_ahead = 3.9 * 86400; }},
    {"stamps", Ask, Side::Box, "The last time stamps are lost", "their file is damaged",
     [](Snapshot& snapshot) { snapshot.box.stamps_damage = "their file is damaged"; }},
    {"ntp", Wait, Side::Box, "NTP is not working", "10.0.0.5 does not answer",
     [](Snapshot& snapshot) { snapshot.box.ntp_trouble = "the NTP server 10.0.0.5 does not answer"; }},
    {"settings_not_changed", Bad, Side::Box, "The last change is not used", "reverted: binding: in use",
     [](Snapshot& snapshot) {
       snapshot.box.change_trouble = "the last change was reverted: binding: in use";
     }},
    {"settings_not_used", Bad, Side::Box, "The saved settings are not used", "version",
     [](Snapshot& snapshot) { snapshot.box.settings_trouble = "version: expected 1"; }},
    {"board_not_used", Bad, Side::Box, "The board file is not used", "panel",
     [](Snapshot& snapshot) { snapshot.box.board_trouble = "panel.helth: no such key"; }},
    {"lights_not_set", Bad, Side::Box, "The lights are unreliable", "cannot set them: panel: chip",
     [](Snapshot& snapshot) { snapshot.box.lights_trouble = "panel: chip gpiochip0: No such device"; }},
    {"notice:disks", Bad, Side::Box, "The box is not healthy", "two disks",
     [](Snapshot& snapshot) { snapshot.box.notices = {{"disks", "there are two disks of Adit's"}}; }},
    {"update_on_trial", Wait, Side::Box, "Version 1.2.0 is on trial", "keep the power on",
     [](Snapshot& snapshot) { snapshot.box.update = {.on_trial = true, .version = "1.2.0"}; }},
    {"other_slot", Ask, Side::Box, "An unexpected slot is running", "it did not come up",
     [](Snapshot& snapshot) {
       snapshot.box.update.stray = "B runs, and A was good last: it did not come up";
     }},
    {"network_change", Ask, Side::Network, "A network change is unconfirmed", "within 88 s at http://1.2.3.4",
     [](Snapshot& snapshot) {
       snapshot.network.confirm_within = 87.5;
       snapshot.network.page = "http://1.2.3.4";
     }},
    {"no_address", Bad, Side::Box, "The upstream address is missing", "set an address",
     [](Snapshot& snapshot) { snapshot.network.no_address = true; }},
    {"address_taken:team", Bad, Side::Network, "The box's address is in conflict",
     "aa:bb also uses 10.0.0.1 on team0; is a spare box plugged in?",
     [](Snapshot& snapshot) { snapshot.network.taken = {{true, "team0", "10.0.0.1", "aa:bb"}}; }},
    {"address_taken:command_post", Bad, Side::Network, "The box's address is in conflict",
     "aa:bb also uses 10.100.1.1 on darpa0",
     [](Snapshot& snapshot) { snapshot.network.taken = {{false, "darpa0", "10.100.1.1", "aa:bb"}}; }},
    {"cables_exchanged", Bad, Side::Network, "The two cables are exchanged",
     "10.100.1.200 answers on team0 instead of darpa0",
     [](Snapshot& snapshot) {
       snapshot.traffic.endpoints.clear();
       snapshot.network.exchanged = {"10.100.1.200", "team0", "darpa0"};
     }},
    {"cable_out:command_post", Bad, Side::Network, "Command Post cable is unplugged", "darpa0 has no link",
     [](Snapshot& snapshot) { snapshot.traffic.links[1].carrier = false; }},
    {"cable_out:team", Bad, Side::Network, "Interface team0 is missing", "set-up names it",
     [](Snapshot& snapshot) { snapshot.traffic.links[0].carrier = {}; }},
};

TEST(Conditions, AreEmptyIfAllIsWell) {
  EXPECT_THAT(conditions_of(well()), IsEmpty());
  EXPECT_THAT(conditions_of({}), IsEmpty()) << "nothing is known yet";
  Snapshot used = well();
  used.box.disk.life = 9, used.box.disk.spares = 1;
  EXPECT_THAT(conditions_of(used), IsEmpty());
}

TEST(Conditions, AreEachFoundAndSayWhatToDo) {
  for (const ConditionCase& each : kConditionCases) {
    Snapshot snapshot = well();
    each.make(snapshot);
    const auto found = conditions_of(snapshot);
    ASSERT_THAT(ids_of(found), ElementsAre(each.id)) << each.what;
    EXPECT_EQ(found[0].severity, each.severity) << each.id;
    EXPECT_EQ(found[0].side, each.side) << each.id;
    EXPECT_EQ(found[0].headline.now(), each.what);
    EXPECT_THAT(found[0].why, HasSubstr(each.why));
    const auto colon = found[0].id.find(':');
    EXPECT_TRUE(colon == std::string::npos || found[0].subject == found[0].id.substr(colon + 1)) << each.id;
    EXPECT_EQ(found[0].action.word.empty(), found[0].action.link.empty()) << each.id;
  }
}

TEST(Conditions, HaveACaseForEachKind) {
  std::set<std::string> made{"robots_silent", "maps_behind"};  // have tests of their own
  for (const ConditionCase& each : kConditionCases) made.insert(kind_of(each.id));
  EXPECT_EQ(made, kinds());
}

TEST(Conditions, LeadToTheFieldsThatMendThem) {
  std::map<std::string, std::string> links;
  for (const ConditionCase& each : kConditionCases) {
    Snapshot snapshot = well();
    each.make(snapshot);
    links[each.id] = conditions_of(snapshot).at(0).action.link;
  }
  EXPECT_EQ(links.at("no_token:scoring"), "/setup#tokens-post");
  EXPECT_EQ(links.at("no_token:mapping"), "/setup#tokens-post");
  EXPECT_EQ(links.at("command_post_refusing"), "/setup#tokens-post");
  EXPECT_EQ(links.at("command_post_foreign"), "/setup#post");
}

TEST(Conditions, HaveHeadlinesOfAtMostSevenWords) {
  for (const ConditionCase& each : kConditionCases) {
    const std::string what = each.what;
    EXPECT_LE(std::ranges::count(what, ' '), 6) << what;
    EXPECT_LE(what.size(), 33u) << what << ": the strip of a small screen cuts a longer one";
    EXPECT_THAT(what, Not(HasSubstr("_"))) << "no field names";
  }
}

TEST(Reasons, EndAtTheLastMarkThatFits) {
  EXPECT_EQ(reason_of("no space"), "no space");
  EXPECT_EQ(reason_of("the counts do not show which of them was recorded: reports left went from 20 to 18"),
            "the counts do not show which of them was recorded");
  EXPECT_EQ(reason_of("the same as report 3, whose run may go on: a new run is not certain (the score fell)"),
            "the same as report 3, whose run may go on");
  EXPECT_EQ(reason_of(std::string(70, 'x')), std::string(57, 'x') + "…") << "somebody else's words";
  EXPECT_EQ(reason_of(std::string(56, 'x') + "ä is cut before the letter"), std::string(56, 'x') + "…");
  EXPECT_EQ(reason_of("words of a sender that have no mark at all and go on like this").back(), "…"[2]);
}

/// The operator sees a short reason in words that he knows. The whole reason is in the list.
TEST(Reasons, AreShortAndNameNoFieldOrProgram) {
  for (const ConditionCase& each : kConditionCases) {
    Snapshot snapshot = well();
    each.make(snapshot);
    const std::string why = conditions_of(snapshot)[0].why, reason = reason_of(why);
    EXPECT_LE(reason.size(), 60u) << each.id;
    EXPECT_THAT(reason, Not(EndsWith("…"))) << each.id << ": " << why;
    for (const char* word : {"aditd", "remaining_reports", "in_doubt"})
      EXPECT_THAT(why, Not(HasSubstr(word))) << each.id;
  }
}

/// Twenty robots with late maps, and two reports whose outcome Adit is finding out.
Snapshot busy() {
  Snapshot snapshot = well(20);
  for (ActivityRow& stream : snapshot.traffic.activities) {
    if (stream.is_map()) stream.age = 100;
  }
  for (std::int64_t number : {1, 2})
    add_report(snapshot, {.number = number, .state = "in_doubt", .asking = true});
  return snapshot;
}

TEST(Causes, HideTheirConsequences) {
  Snapshot snapshot = busy();
  both_down<EndpointFault::Silent>(snapshot);
  const auto found = conditions_of(snapshot);
  ASSERT_THAT(ids_of(found), ElementsAre("command_post_silent"));
  EXPECT_EQ(found[0].hides, 22u) << "20 maps and 2 reports";
}

TEST(Causes, PreferTheCableToTheEndpoint) {
  Snapshot snapshot = busy();
  both_down<EndpointFault::Unreachable>(snapshot);
  snapshot.traffic.links[1].carrier = false;
  const auto found = conditions_of(snapshot);
  ASSERT_THAT(ids_of(found), ElementsAre("cable_out:command_post"));
  EXPECT_EQ(found[0].hides, 23u);
}

TEST(Causes, PreferExchangedCablesToEndpointsAndRobots) {
  for (const auto trouble : {EndpointFault::Unreachable, EndpointFault::Silent, EndpointFault::NoToken}) {
    Snapshot snapshot = busy();
    for (auto& [name, robot] : snapshot.traffic.habits) robot = {.gap = 1, .quiet = 60, .silent = true};
    snapshot.network.exchanged = {"10.100.1.200", "team0", "darpa0"};
    for (EndpointRow& endpoint : snapshot.traffic.endpoints) endpoint.fault = trouble;
    const auto found = conditions_of(snapshot);
    const Condition alarm = find(found, "cables_exchanged");
    EXPECT_EQ(alarm.headline.now(), "The two cables are exchanged");
    EXPECT_GE(alarm.hides, 22u);
    for (const std::string& id : ids_of(found))
      EXPECT_TRUE(id == "cables_exchanged" || id.starts_with("no_token")) << id;
  }
}

TEST(Causes, ExcludeExchangedCablesWhileAnEndpointAnswers) {
  for (const auto trouble : {EndpointFault::None, EndpointFault::Refusing, EndpointFault::Foreign,
                             EndpointFault::Failing, EndpointFault::Throttling}) {
    Snapshot snapshot = well();
    snapshot.network.exchanged = {"10.100.1.200", "team0", "darpa0"};
    down(snapshot, EndpointFault::Unreachable, 0);
    snapshot.traffic.endpoints[1].fault = trouble;
    EXPECT_EQ(find(conditions_of(snapshot), "cables_exchanged").id, "");
  }
}

TEST(Causes, OfOneEndpointDoNotHideTheOther) {
  Snapshot snapshot = busy();
  down(snapshot, EndpointFault::Unreachable, 0);
  EXPECT_THAT(ids_of(conditions_of(snapshot)), ElementsAre("command_post_unreachable", "maps_behind"));
  snapshot = busy();
  down(snapshot, EndpointFault::Failing, 1);
  EXPECT_THAT(ids_of(conditions_of(snapshot)),
              ElementsAre("command_post_failing", "report_in_doubt:1", "report_in_doubt:2"));
}

TEST(Causes, DoNotHideDecisionsOfTheOperator) {
  Snapshot snapshot = well();
  both_down<EndpointFault::Silent>(snapshot);
  snapshot.traffic.links[1].carrier = false;
  report(snapshot, "in_doubt");
  reject(snapshot, 1);
  snapshot.reports.left = 0;
  EXPECT_THAT(ids_of(conditions_of(snapshot)), ElementsAre("cable_out:command_post", "report_in_doubt:7",
                                                           "reports_left", "messages_rejected"));
}

TEST(Causes, ThrottlingHidesNothing) {
  Snapshot snapshot = well();
  down(snapshot, EndpointFault::Throttling, 1);
  snapshot.traffic.activities[0].age = 30;
  EXPECT_THAT(ids_of(conditions_of(snapshot)), ElementsAre("command_post_throttling", "map_behind:uav1"));
}

TEST(Robots, AreNotBlamedWhileTheEndpointIsDown) {
  Snapshot snapshot = well(20);
  for (auto& [name, robot] : snapshot.traffic.habits) robot = {.gap = 1, .quiet = 60, .silent = true};
  both_down<EndpointFault::Unreachable>(snapshot);
  const auto found = conditions_of(snapshot);
  ASSERT_THAT(ids_of(found), ElementsAre("command_post_unreachable"));
  EXPECT_EQ(found[0].hides, 20u);
}

TEST(Robots, AllSilentAreOneCondition) {
  Snapshot snapshot = well(20);
  for (auto& [name, robot] : snapshot.traffic.habits) robot = {.gap = 1, .quiet = 60, .silent = true};
  const auto found = conditions_of(snapshot);
  ASSERT_THAT(ids_of(found), ElementsAre("robots_silent"));
  EXPECT_EQ(found[0].headline.now(), "All 20 robots are silent");
  EXPECT_EQ(found[0].hides, 20u);
  EXPECT_EQ(found[0].since, kNow - 60);
  snapshot.traffic.habits["uav5"].silent = false;
  EXPECT_EQ(conditions_of(snapshot)[0].headline.now(), "19 robots are silent");
  for (int i = 6; i <= 20; ++i) snapshot.traffic.habits.erase("uav" + std::to_string(i));
  const auto last = conditions_of(snapshot);
  EXPECT_EQ(last[0].headline.now(), "4 robots are silent")
      << "those that have just returned have no habit yet";
  snapshot.traffic.habits["uav4"].silent = false;
  EXPECT_THAT(ids_of(conditions_of(snapshot)),
              ElementsAre("robot_silent:uav1", "robot_silent:uav2", "robot_silent:uav3"));
  snapshot.traffic.habits.erase("uav3"), snapshot.traffic.habits.erase("uav4"),
      snapshot.traffic.habits.erase("uav5");
  EXPECT_EQ(conditions_of(snapshot).size(), 2u) << "two are not all, although no other has a habit";
}

TEST(Robots, AreNotBlamedWhileTheTeamCableIsOut) {
  Snapshot snapshot = well(2);
  snapshot.traffic.habits["uav1"].silent = true;
  snapshot.traffic.links[0].carrier = false;
  EXPECT_THAT(ids_of(conditions_of(snapshot)), ElementsAre("cable_out:team"));
}

TEST(Maps, OfManyRobotsBehindAreOneCondition) {
  Snapshot snapshot = well(6);
  for (ActivityRow& stream : snapshot.traffic.activities) {
    if (stream.is_map()) stream.age = 30;
  }
  const auto found = conditions_of(snapshot);
  ASSERT_THAT(ids_of(found), ElementsAre("maps_behind"));
  EXPECT_EQ(found[0].headline.now(), "Maps of 6 robots are behind");
}

TEST(Maps, AreNotBehindWhileTakingTurns) {
  Snapshot snapshot = well(6);
  snapshot.traffic.turn = 20;
  for (ActivityRow& stream : snapshot.traffic.activities) {
    if (stream.is_map()) stream.age = 30;
  }
  EXPECT_THAT(conditions_of(snapshot), IsEmpty());
}

TEST(Maps, AreNotBehindJustAfterAnOutage) {
  Snapshot snapshot = well(1);
  snapshot.traffic.activities[0].age = 300;
  snapshot.traffic.endpoints[1].well_for = 20;
  EXPECT_THAT(conditions_of(snapshot), IsEmpty()) << "the robot has its turn now";
  snapshot.traffic.endpoints[1].well_for = 21;
  const auto found = conditions_of(snapshot);
  ASSERT_THAT(ids_of(found), ElementsAre("map_behind:uav1"));
  EXPECT_EQ(found[0].severity, Severity::Wait);
  EXPECT_EQ(found[0].since, snapshot.traffic.now - 300);
  snapshot.traffic.endpoints[0].well_for = 1;
  snapshot.traffic.endpoints[1].well_for.reset();
  EXPECT_THAT(ids_of(conditions_of(snapshot)), ElementsAre("map_behind:uav1")) << "scoring accepts no maps";
}

TEST(Queue, NamesThreeRejectedClientsForAMinute) {
  Snapshot snapshot = well();
  snapshot.traffic.activities = {{.kind = "cloud", .last_no_room = kNow - 61},
                                 {.kind = "cloud", .robot = "r1", .last_no_room = kNow - 60},
                                 {.kind = "markers", .last_no_room = kNow - 1}};
  EXPECT_THAT(conditions_of(snapshot)[0].why, HasSubstr("has room: r1 cloud, markers"));
  for (int robot = 0; robot < 9; ++robot)
    snapshot.traffic.activities.push_back(
        {.kind = "grid", .robot = icd::sentence("g", robot), .last_no_room = kNow - 1});
  EXPECT_THAT(conditions_of(snapshot)[0].why, HasSubstr("r1 cloud, markers, g0 grid and 8 more"));
}

/// A disk with that much room on which nothing can be written.
Snapshot scarce(std::uint64_t free) {
  Snapshot snapshot = well();
  snapshot.box.disk.free = free;
  snapshot.box.ledger_refusal = snapshot.box.disk.run = "no space";
  return snapshot;
}

TEST(ScarceDisk, IsOneAlarmThatNamesItsConsequences) {
  const auto found = conditions_of(scarce(200'000));
  ASSERT_THAT(ids_of(found), ElementsAre("ledger_unwritable"));
  EXPECT_EQ(found[0].hides, 2u);
  EXPECT_EQ(
      found[0].why,
      "only 200 kB of the disk are free; the box cannot write the ledger: no space; the run's map is not "
      "stored, so a restart would lose it: no space");
}

TEST(ScarceDisk, DoesNotHideAFaultThatIsNotOfSpace) {
  Snapshot snapshot = scarce(0);
  snapshot.box.ledger_refusal = "I/O error";
  EXPECT_THAT(conditions_of(snapshot)[0].why, HasSubstr("the box cannot write the ledger: I/O error"));
  snapshot.box.ledger_is_closed = true;
  snapshot.box.disk.map = snapshot.box.disk.state = "the memory is full";
  EXPECT_THAT(ids_of(conditions_of(snapshot)),
              ElementsAre("ledger_unwritable", "disk_full", "map_not_kept", "state_not_kept"));
}

TEST(ScarceDisk, GetsWorseByEachConsequence) {
  Snapshot snapshot = scarce(0);
  const auto both = conditions_of(snapshot)[0].degree;
  snapshot.box.disk.run.clear();
  const auto one = conditions_of(snapshot)[0].degree;
  EXPECT_GT(both, one);
  snapshot.box.disk.free = 200'000;
  EXPECT_GT(one, conditions_of(snapshot)[0].degree);
}

TEST(ReportsToDecide, AreListedUpToALimit) {
  Snapshot snapshot = well();
  for (std::int64_t number = 1; number <= 12; ++number)
    add_report(snapshot, {.number = number, .state = "held", .note = "all are"});
  const auto found = conditions_of(snapshot);
  EXPECT_EQ(found.size(), kOneByOne + 1);
  EXPECT_EQ(find(found, "report_held:more").headline.now(), "2 more reports are held");
  EXPECT_EQ(find(found, "report_held:more").degree, 2u);
}

TEST(ReportsToDecide, WaitWhileAditAsks) {
  Snapshot snapshot = well();
  snapshot.reports.rows.push_back(
      {.number = 3, .state = "in_doubt", .note = "POST /api to 10.0.0.1:8000: no answer", .asking = true});
  EXPECT_EQ(conditions_of(snapshot)[0].severity, Severity::Wait);
  EXPECT_THAT(conditions_of(snapshot)[0].why, HasSubstr("its answer was lost"));
}

TEST(RejectedMessages, GetWorseByEachNewOneEvenIfFull) {
  Snapshot snapshot = well();
  reject(snapshot, 100);
  const auto before = conditions_of(snapshot);
  snapshot.reports.rejected.erase(snapshot.reports.rejected.begin());
  snapshot.reports.rejected.push_back({.number = 101, .status = 413});
  EXPECT_GT(conditions_of(snapshot)[0].degree, before[0].degree);
}

TEST(FewReports, GetWorseAsTheyGetFewer) {
  Snapshot snapshot = well();
  snapshot.reports.left = 3;
  const auto before = conditions_of(snapshot);
  snapshot.reports.left = 2;
  EXPECT_GT(conditions_of(snapshot)[0].degree, before[0].degree);
  snapshot.reports.left = 6;
  EXPECT_THAT(conditions_of(snapshot), IsEmpty());
}

}  // namespace
}  // namespace adit::alarms
