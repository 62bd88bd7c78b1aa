#include "alarms/conditions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "alarms/alike.hpp"
#include "icd/sentence.hpp"

namespace adit::alarms {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using enum Severity;

/// Facts that make a condition true while all others are false.
struct ConditionCase {
  const char* id;
  Severity severity;
  Side side;
  const char* what;
  const char* why;  // a part of it
  void (*make)(Facts&);
};

void down(Facts& facts, EndpointTrouble trouble, std::size_t endpoint) {
  facts.endpoints[endpoint].trouble = trouble;
  facts.endpoints[endpoint].since = kNow - 20;
  facts.endpoints[endpoint].said = "Connection refused";
}

template <EndpointTrouble trouble>
void both_down(Facts& facts) {
  down(facts, trouble, 0);
  down(facts, trouble, 1);
}

template <ReportFact::Is is>
void report(Facts& facts) {
  facts.reports.push_back({.number = 7, .is = is, .note = "it may be the same", .since = kNow - 5});
}

const ConditionCase kConditionCases[] = {
    {"command_post_unreachable", Bad, Side::CommandPost, "Command Post is unreachable", "Connection refused",
     both_down<EndpointTrouble::Unreachable>},
    {"command_post_silent", Bad, Side::CommandPost, "Command Post is silent", "10.100.1.200:8000 and",
     both_down<EndpointTrouble::Silent>},
    {"command_post_refusing", Bad, Side::CommandPost, "Both tokens are rejected", "is the course right?",
     both_down<EndpointTrouble::Refusing>},
    {"command_post_refusing", Bad, Side::CommandPost, "The scoring token is rejected", "is the course right?",
     [](Facts& facts) { down(facts, EndpointTrouble::Refusing, 0); }},
    {"command_post_refusing", Bad, Side::CommandPost, "The mapping token is rejected", "know uav1?",
     [](Facts& facts) {
       down(facts, EndpointTrouble::Refusing, 1);
       std::erase_if(facts.streams, [](const Stream& stream) { return stream.robot != "uav1"; });
     }},
    {"command_post_foreign", Bad, Side::CommandPost, "The server is not a Command Post", "(mapping)",
     [](Facts& facts) { down(facts, EndpointTrouble::Foreign, 1); }},
    {"command_post_failing", Bad, Side::CommandPost, "Mapping is failing", "every request",
     [](Facts& facts) { down(facts, EndpointTrouble::Failing, 1); }},
    {"command_post_throttling", Wait, Side::CommandPost, "Mapping is throttling", "429",
     [](Facts& facts) { down(facts, EndpointTrouble::Throttling, 1); }},
    {"no_token:scoring", Bad, Side::Box, "The scoring token is missing", "reports stay queued",
     [](Facts& facts) { down(facts, EndpointTrouble::NoToken, 0); }},
    {"no_token:mapping", Bad, Side::Box, "The mapping token is missing",
     "maps, states and markers stay queued", [](Facts& facts) { down(facts, EndpointTrouble::NoToken, 1); }},
    {"no_token:team", Bad, Side::Box, "The team token is missing", "rejects every robot",
     [](Facts& facts) { facts.shut_out = true; }},
    {"robot_silent:uav2", Bad, Side::Robot, "uav2 is silent", "a message every 2 s",
     [](Facts& facts) { facts.robots["uav2"] = {.gap = 2, .quiet = 94, .silent = true}; }},
    {"map_behind:uav1", Wait, Side::CommandPost, "uav1's map is behind", "grid",
     [](Facts& facts) { facts.streams[0].behind = 21; }},
    {"map_behind:uav1", Bad, Side::CommandPost, "uav1's map is behind", "grid",
     [](Facts& facts) { facts.streams[0].behind = 91; }},
    {"queue_growing", Wait, Side::Network, "The map queue is growing", "0 MB are queued",
     [](Facts& facts) { facts.queue_grows = true; }},
    {"queue_nearly_full", Bad, Side::Network, "The map queue is nearly full", "104 MB",
     [](Facts& facts) { facts.queued = 81u << 20; }},
    {"queue_full", Bad, Side::Network, "The queue is full", "uav1 grid",
     [](Facts& facts) { facts.streams[0].no_room = 59; }},
    {"robot_unknown:uav9", Ask, Side::Robot, "Robot uav9 is unknown", "only uav1, uav2",
     [](Facts& facts) {
       facts.unknown_robots = {"uav9"};
       facts.known_robots = {"uav1", "uav2"};
     }},
    {"clients_refused", Bad, Side::Robot, "Clients are rejected", "10.0.0.9",
     [](Facts& facts) { facts.crowds = {{CrowdFact::Is::NoRoom, "10.0.0.9"}}; }},
    {"wrong_tokens", Ask, Side::Robot, "Wrong tokens are in use", "10.0.0.9",
     [](Facts& facts) { facts.crowds = {{CrowdFact::Is::WrongToken, "10.0.0.9"}}; }},
    {"unauthenticated", Wait, Side::Robot, "Too many clients are anonymous", "10.0.0.9",
     [](Facts& facts) { facts.crowds = {{CrowdFact::Is::Unauthenticated, "10.0.0.9"}}; }},
    {"report_held:7", Ask, Side::Box, "Report 7 is held", "it may be the same", report<ReportFact::Is::Held>},
    {"report_in_doubt:7", Ask, Side::CommandPost, "Report 7 is in doubt", "",
     report<ReportFact::Is::InDoubt>},
    {"report_lost:7", Ask, Side::Box, "Report 7 is lost", "mark it as done", report<ReportFact::Is::Lost>},
    {"reports_left", Wait, Side::CommandPost, "5 reports are left", "",
     [](Facts& facts) { facts.reports_left = 5; }},
    {"reports_left", Wait, Side::CommandPost, "1 report is left", "",
     [](Facts& facts) { facts.reports_left = 1; }},
    {"reports_left", Bad, Side::CommandPost, "No reports are left", "",
     [](Facts& facts) { facts.reports_left = 0; }},
    {"reports_elsewhere:10.9.9.9:1", Ask, Side::Box, "2 reports are for another server", "10.9.9.9:1",
     [](Facts& facts) { facts.reports_elsewhere["10.9.9.9:1"] = 2; }},
    {"run_unreliable", Ask, Side::CommandPost, "The count of reports is uncertain", "somebody else",
     [](Facts& facts) { facts.run_unreliable = "somebody else reports"; }},
    {"run_renamed", Ask, Side::CommandPost, "The name of the run is uncertain", "calls it run 2",
     [](Facts& facts) { facts.run_renamed = "the Command Post calls it run 2, it was 1"; }},
    {"messages_rejected", Ask, Side::CommandPost, "3 messages are rejected",
     "did not accept them; the newest: ugv1's cloud: too large (3021 kB)",
     [](Facts& facts) {
       facts.messages_rejected = 3;
       facts.newest_rejected_why = "ugv1's cloud: too large (3021 kB)";
     }},
    {"standby", Bad, Side::Box, "This box is on standby", "for its spare",
     [](Facts& facts) { facts.standby = "put on standby for its spare to take over"; }},
    {"ledger_unwritable", Bad, Side::Box, "Reports are not accepted", "cannot write the ledger: no space",
     [](Facts& facts) { facts.ledger_refusal = "no space"; }},
    {"ledger_unwritable", Bad, Side::Box, "Reports are not accepted", "or run adit ledger new: I/O error",
     [](Facts& facts) { facts.ledger_refusal = "I/O error", facts.ledger_is_closed = true; }},
    {"ledger_damaged", Ask, Side::Box, "The ledger is damaged", "a page",
     [](Facts& facts) { facts.ledger_damage = "a page was put aside"; }},
    {"other_ledger", Ask, Side::Box, "An earlier ledger is not read", "/var/lib/adit/ledger.sqlite",
     [](Facts& facts) { facts.other_ledger = "/var/lib/adit/ledger.sqlite"; }},
    {"queue_put_aside", Ask, Side::Box, "Queued messages are put aside", "3 times",
     [](Facts& facts) { facts.put_aside = "aditd ended 3 times"; }},
    {"map_not_kept", Bad, Side::Box, "The last map is not accepted", "no space",
     [](Facts& facts) { facts.disk.map = "no space"; }},
    {"state_not_kept", Bad, Side::Box, "States and markers are rejected", "cannot store them: no space",
     [](Facts& facts) { facts.disk.state = "no space"; }},
    {"run_not_kept", Bad, Side::Box, "The run's map is not stored", "a restart would lose it: no space",
     [](Facts& facts) { facts.disk.run = "no space"; }},
    {"disk_full", Bad, Side::Box, "The disk is nearly full", "512 kB",
     [](Facts& facts) { facts.disk.free = 500u << 10; }},
    {"disk_health", Ask, Side::Box, "The disk is nearly worn out", "90 % of its life",
     [](Facts& facts) { facts.disk.life = 10; }},
    {"disk_health", Ask, Side::Box, "The disk is nearly worn out", "its expected life is over",
     [](Facts& facts) { facts.disk.life = 11, facts.disk.spares = 3; }},
    {"disk_health", Ask, Side::Box, "The disk is nearly worn out", "80 % of its spare blocks",
     [](Facts& facts) { facts.disk.life = 9, facts.disk.spares = 2; }},
    {"disk_health", Wait, Side::Box, "The disk's health is unknown", "life_time: Input/output error",
     [](Facts& facts) { facts.disk.wear_unknown = "life_time: Input/output error"; }},
    {"time_not_set", Wait, Side::Box, "The time of day is not set", "adit clock set",
     [](Facts& facts) { facts.time_set = false; }},
    {"stamps", Ask, Side::Box, "Time stamps are ahead", "by 3 days; a factory reset",
     [](Facts& facts) { facts.stamps_ahead = 3.9 * 86400; }},
    {"stamps", Ask, Side::Box, "The last time stamps are lost", "their file is damaged",
     [](Facts& facts) { facts.stamps_damage = "their file is damaged"; }},
    {"ntp", Wait, Side::Box, "NTP is not working", "10.0.0.5 does not answer",
     [](Facts& facts) { facts.ntp_trouble = "the NTP server 10.0.0.5 does not answer"; }},
    {"settings_not_changed", Bad, Side::Box, "The last change is not used", "reverted: binding: in use",
     [](Facts& facts) { facts.change_trouble = "the last change was reverted: binding: in use"; }},
    {"settings_not_used", Bad, Side::Box, "The saved settings are not used", "version",
     [](Facts& facts) { facts.settings_trouble = "version: expected 1"; }},
    {"board_not_used", Bad, Side::Box, "The board file is not used", "panel",
     [](Facts& facts) { facts.board_trouble = "panel.helth: no such key"; }},
    {"lights_not_set", Bad, Side::Box, "The lights are unreliable", "cannot set them: panel: chip",
     [](Facts& facts) { facts.lights_trouble = "panel: chip gpiochip0: No such device"; }},
    {"notice:disks", Bad, Side::Box, "The box is not healthy", "two disks",
     [](Facts& facts) { facts.notices = {{"disks", "there are two disks of Adit's"}}; }},
    {"update_on_trial", Wait, Side::Box, "Version 1.2.0 is on trial", "keep the power on",
     [](Facts& facts) { facts.update = {.on_trial = true, .version = "1.2.0"}; }},
    {"other_slot", Ask, Side::Box, "An unexpected slot is running", "it did not come up",
     [](Facts& facts) { facts.update.stray = "B runs, and A was good last: it did not come up"; }},
    {"network_change", Ask, Side::Network, "A network change is unconfirmed", "within 88 s at http://1.2.3.4",
     [](Facts& facts) {
       facts.network.confirm_within = 87.5;
       facts.network.page = "http://1.2.3.4";
     }},
    {"no_address", Bad, Side::Box, "The upstream address is missing", "set an address",
     [](Facts& facts) { facts.network.no_address = true; }},
    {"address_taken:team", Bad, Side::Network, "The box's address is in conflict",
     "aa:bb also uses 10.0.0.1 on team0; is a spare box plugged in?",
     [](Facts& facts) { facts.network.taken = {{true, "team0", "10.0.0.1", "aa:bb"}}; }},
    {"address_taken:command_post", Bad, Side::Network, "The box's address is in conflict",
     "aa:bb also uses 10.100.1.1 on darpa0",
     [](Facts& facts) { facts.network.taken = {{false, "darpa0", "10.100.1.1", "aa:bb"}}; }},
    {"cables_exchanged", Bad, Side::Network, "The two cables are exchanged",
     "10.100.1.200 answers on team0 instead of darpa0",
     [](Facts& facts) {
       facts.endpoints.clear();
       facts.network.exchanged = {"10.100.1.200", "team0", "darpa0"};
     }},
    {"cable_out:command_post", Bad, Side::Network, "Command Post cable is unplugged", "darpa0 has no link",
     [](Facts& facts) { facts.cables[1].carrier = false; }},
    {"cable_out:team", Bad, Side::Network, "Interface team0 is missing", "set-up names it",
     [](Facts& facts) { facts.cables[0].carrier = {}; }},
};

TEST(Conditions, AreEmptyIfAllIsWell) {
  EXPECT_THAT(conditions_of(well()), IsEmpty());
  EXPECT_THAT(conditions_of({}), IsEmpty()) << "no facts are known yet";
  Facts used = well();
  used.disk.life = 9, used.disk.spares = 1;
  EXPECT_THAT(conditions_of(used), IsEmpty());
}

TEST(Conditions, AreEachFoundAndSayWhatToDo) {
  for (const ConditionCase& each : kConditionCases) {
    Facts facts = well();
    each.make(facts);
    const auto found = conditions_of(facts);
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

TEST(Conditions, HaveHeadlinesOfAtMostSevenWords) {
  for (const ConditionCase& each : kConditionCases) {
    const std::string what = each.what;
    EXPECT_LE(std::ranges::count(what, ' '), 6) << what;
    EXPECT_LE(what.size(), 33u) << what << ": the strip of a small screen cuts a longer one";
    EXPECT_THAT(what, Not(HasSubstr("_"))) << "no field names";
  }
}

/// Twenty robots with late maps, and two reports whose outcome Adit is finding out.
Facts busy() {
  Facts facts = well(20);
  for (Stream& stream : facts.streams) {
    if (stream.is_map()) stream.behind = 100;
  }
  for (std::int64_t number : {1, 2})
    facts.reports.push_back({.number = number, .is = ReportFact::Is::InDoubt, .asking = true});
  return facts;
}

TEST(Causes, HideTheirConsequences) {
  Facts facts = busy();
  both_down<EndpointTrouble::Silent>(facts);
  const auto found = conditions_of(facts);
  ASSERT_THAT(ids_of(found), ElementsAre("command_post_silent"));
  EXPECT_EQ(found[0].hides, 22u) << "20 maps and 2 reports";
}

TEST(Causes, PreferTheCableToTheEndpoint) {
  Facts facts = busy();
  both_down<EndpointTrouble::Unreachable>(facts);
  facts.cables[1].carrier = false;
  const auto found = conditions_of(facts);
  ASSERT_THAT(ids_of(found), ElementsAre("cable_out:command_post"));
  EXPECT_EQ(found[0].hides, 23u);
}

TEST(Causes, PreferExchangedCablesToEndpointsAndRobots) {
  for (const auto trouble :
       {EndpointTrouble::Unreachable, EndpointTrouble::Silent, EndpointTrouble::NoToken}) {
    Facts facts = busy();
    for (auto& [name, robot] : facts.robots) robot = {.gap = 1, .quiet = 60, .silent = true};
    facts.network.exchanged = {"10.100.1.200", "team0", "darpa0"};
    for (Endpoint& endpoint : facts.endpoints) endpoint.trouble = trouble;
    const auto found = conditions_of(facts);
    const Condition alarm = find(found, "cables_exchanged");
    EXPECT_EQ(alarm.headline.now(), "The two cables are exchanged");
    EXPECT_GE(alarm.hides, 22u);
    for (const std::string& id : ids_of(found))
      EXPECT_TRUE(id == "cables_exchanged" || id.starts_with("no_token")) << id;
  }
}

TEST(Causes, ExcludeExchangedCablesWhileAnEndpointAnswers) {
  for (const auto trouble : {EndpointTrouble::None, EndpointTrouble::Refusing, EndpointTrouble::Foreign,
                             EndpointTrouble::Failing, EndpointTrouble::Throttling}) {
    Facts facts = well();
    facts.network.exchanged = {"10.100.1.200", "team0", "darpa0"};
    down(facts, EndpointTrouble::Unreachable, 0);
    facts.endpoints[1].trouble = trouble;
    EXPECT_EQ(find(conditions_of(facts), "cables_exchanged").id, "");
  }
}

TEST(Causes, OfOneEndpointDoNotHideTheOther) {
  Facts facts = busy();
  down(facts, EndpointTrouble::Unreachable, 0);
  EXPECT_THAT(ids_of(conditions_of(facts)), ElementsAre("command_post_unreachable", "maps_behind"));
  facts = busy();
  down(facts, EndpointTrouble::Failing, 1);
  EXPECT_THAT(ids_of(conditions_of(facts)),
              ElementsAre("command_post_failing", "report_in_doubt:1", "report_in_doubt:2"));
}

TEST(Causes, DoNotHideDecisionsOfTheOperator) {
  Facts facts = well();
  both_down<EndpointTrouble::Silent>(facts);
  facts.cables[1].carrier = false;
  report<ReportFact::Is::InDoubt>(facts);
  facts.messages_rejected = 1;
  facts.reports_left = 0;
  EXPECT_THAT(ids_of(conditions_of(facts)), ElementsAre("cable_out:command_post", "report_in_doubt:7",
                                                        "reports_left", "messages_rejected"));
}

TEST(Causes, ThrottlingHidesNothing) {
  Facts facts = well();
  down(facts, EndpointTrouble::Throttling, 1);
  facts.streams[0].behind = 30;
  EXPECT_THAT(ids_of(conditions_of(facts)), ElementsAre("command_post_throttling", "map_behind:uav1"));
}

TEST(Robots, AreNotBlamedWhileTheEndpointIsDown) {
  Facts facts = well(20);
  for (auto& [name, robot] : facts.robots) robot = {.gap = 1, .quiet = 60, .silent = true};
  both_down<EndpointTrouble::Unreachable>(facts);
  const auto found = conditions_of(facts);
  ASSERT_THAT(ids_of(found), ElementsAre("command_post_unreachable"));
  EXPECT_EQ(found[0].hides, 20u);
}

TEST(Robots, AllSilentAreOneCondition) {
  Facts facts = well(20);
  for (auto& [name, robot] : facts.robots) robot = {.gap = 1, .quiet = 60, .silent = true};
  const auto found = conditions_of(facts);
  ASSERT_THAT(ids_of(found), ElementsAre("robots_silent"));
  EXPECT_EQ(found[0].headline.now(), "All 20 robots are silent");
  EXPECT_EQ(found[0].hides, 20u);
  EXPECT_EQ(found[0].since, kNow - 60);
  facts.robots["uav5"].silent = false;
  EXPECT_EQ(conditions_of(facts).size(), 19u);
}

TEST(Robots, AreNotBlamedWhileTheTeamCableIsOut) {
  Facts facts = well(2);
  facts.robots["uav1"].silent = true;
  facts.cables[0].carrier = false;
  EXPECT_THAT(ids_of(conditions_of(facts)), ElementsAre("cable_out:team"));
}

TEST(Maps, OfManyRobotsBehindAreOneCondition) {
  Facts facts = well(6);
  for (Stream& stream : facts.streams) {
    if (stream.is_map()) stream.behind = 30;
  }
  const auto found = conditions_of(facts);
  ASSERT_THAT(ids_of(found), ElementsAre("maps_behind"));
  EXPECT_EQ(found[0].headline.now(), "Maps of 6 robots are behind");
}

TEST(Maps, AreNotBehindWhileTakingTurns) {
  Facts facts = well(6);
  facts.turn = 20;
  for (Stream& stream : facts.streams) {
    if (stream.is_map()) stream.behind = 30;
  }
  EXPECT_THAT(conditions_of(facts), IsEmpty());
}

TEST(Maps, AreNotBehindJustAfterAnOutage) {
  Facts facts = well(1);
  facts.streams[0].behind = 300;
  facts.endpoints[1].well_for = 20;
  EXPECT_THAT(conditions_of(facts), IsEmpty()) << "the robot has its turn now";
  facts.endpoints[1].well_for = 21;
  const auto found = conditions_of(facts);
  ASSERT_THAT(ids_of(found), ElementsAre("map_behind:uav1"));
  EXPECT_EQ(found[0].severity, Severity::Wait);
  EXPECT_EQ(found[0].since, facts.now - 300);
  facts.endpoints[0].well_for = 1;
  facts.endpoints[1].well_for.reset();
  EXPECT_THAT(ids_of(conditions_of(facts)), ElementsAre("map_behind:uav1")) << "scoring accepts no maps";
}

TEST(Queue, NamesThreeRejectedClientsForAMinute) {
  Facts facts = well();
  facts.streams = {{.kind = "cloud", .no_room = 61},
                   {.kind = "cloud", .robot = "r1", .no_room = 60},
                   {.kind = "markers", .no_room = 1}};
  EXPECT_THAT(conditions_of(facts)[0].why, HasSubstr("has room: r1 cloud, markers"));
  for (int robot = 0; robot < 9; ++robot)
    facts.streams.push_back({.kind = "grid", .robot = icd::sentence("g", robot), .no_room = 1});
  EXPECT_THAT(conditions_of(facts)[0].why, HasSubstr("r1 cloud, markers, g0 grid and 8 more"));
}

TEST(ReportsToDecide, AreListedUpToALimit) {
  Facts facts = well();
  for (std::int64_t number = 1; number <= 12; ++number)
    facts.reports.push_back({.number = number, .is = ReportFact::Is::Held, .note = "all are"});
  const auto found = conditions_of(facts);
  EXPECT_EQ(found.size(), kOneByOne + 1);
  EXPECT_EQ(find(found, "report_held:more").headline.now(), "2 more reports are held");
  EXPECT_EQ(find(found, "report_held:more").degree, 2u);
}

TEST(ReportsToDecide, WaitWhileAditAsks) {
  Facts facts = well();
  facts.reports.push_back(
      {.number = 3, .is = ReportFact::Is::InDoubt, .asking = true, .note = "no answer came"});
  EXPECT_EQ(conditions_of(facts)[0].severity, Severity::Wait);
}

TEST(RejectedMessages, GetWorseByEachNewOneEvenIfFull) {
  Facts facts = well();
  facts.messages_rejected = 100;
  facts.newest_rejected = 100;
  const auto before = conditions_of(facts);
  facts.newest_rejected = 101;
  EXPECT_GT(conditions_of(facts)[0].degree, before[0].degree);
}

TEST(FewReports, GetWorseAsTheyGetFewer) {
  Facts facts = well();
  facts.reports_left = 3;
  const auto before = conditions_of(facts);
  facts.reports_left = 2;
  EXPECT_GT(conditions_of(facts)[0].degree, before[0].degree);
  facts.reports_left = 6;
  EXPECT_THAT(conditions_of(facts), IsEmpty());
}

}  // namespace
}  // namespace adit::alarms
