// What operators read about alarms, TROUBLE.md and the card (board/card.html), with the rules' current texts.
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <sstream>

#include "alarms/kinds.hpp"
#include "project_files.hpp"

namespace adit::alarms {
namespace {

/// Two robots. One has a placeholder as its name.
Snapshot named() {
  Snapshot snapshot = well(1);
  for (EndpointRow& endpoint : snapshot.traffic.endpoints) endpoint.address = "ADDRESS";
  snapshot.traffic.habits["NAME"] = {.gap = 1, .quiet = 1};
  snapshot.traffic.activities.push_back(
      {.kind = "grid", .robot = "NAME", .last_forwarded = kNow, .heard = 1.0, .last_status = 200});
  return snapshot;
}

void both_have(Snapshot& snapshot, EndpointFault trouble) {
  for (EndpointRow& endpoint : snapshot.traffic.endpoints) {
    endpoint.fault = trouble;
    endpoint.said = trouble == EndpointFault::Failing ? "500" : "no route to host";
  }
}

void robots_and_queue(std::vector<Snapshot>& days) {
  days.push_back(named());
  days.back().traffic.habits["NAME"].silent = true;
  days.back().traffic.activities.back().age = 100;
  days.back().traffic.activities.back().last_no_room = kNow - 1;
  days.back().clients.unknown_robots = {"NAME"};
  days.back().traffic.registered = {"uav1"};
  days.back().clients.crowds = {{Crowd::Kind::NoRoom, "ADDRESS"},
                                {Crowd::Kind::WrongToken, "ADDRESS"},
                                {Crowd::Kind::NoToken, "ADDRESS"},
                                {Crowd::Kind::Unauthenticated, "ADDRESS"}};
  days.back().clients.shut_out = true;
  days.push_back(well(6));
  for (auto& [name, robot] : days.back().traffic.habits) robot.silent = true;
  for (ActivityRow& stream : days.back().traffic.activities) stream.age = 100;
  days.push_back(named());
  days.back().traffic.queued = days.back().traffic.queue_room;
  days.push_back(named());
  days.back().traffic.queue_grows = true;
  days.back().traffic.queued = 60u << 20;
}

void reports(std::vector<Snapshot>& days) {
  days.push_back(named());
  days.back().reports.rows = {
      {.number = 7, .position = {}, .state = "in_doubt", .note = "a row is damaged", .run = 0},
      {.number = 7, .state = "in_doubt", .note = "the status cannot tell"},
      {.number = 7, .state = "held", .note = "close to report 5"}};
  days.back().reports.left = 5;
  days.back().reports.elsewhere["ADDRESS"] = 2;
  days.back().reports.run_unreliable = "somebody else reports with this token";
  days.back().reports.run_renamed = "run 2, was 1";
  for (std::uint64_t number = 1; number <= 3; ++number) {
    days.back().reports.rejected.push_back(
        {.number = number, .kind = "cloud", .robot = "NAME", .status = 413, .why = "too large"});
  }
  days.push_back(named());
  days.back().reports.left = 0;
}

void the_box(std::vector<Snapshot>& days) {
  days.push_back(named());
  days.back().box.disk.free = 500u << 10;
  days.push_back(named());
  Snapshot& snapshot = days.back();
  snapshot.box.ledger_refusal = snapshot.box.disk.map = snapshot.box.disk.state = snapshot.box.disk.run =
      "no space";
  snapshot.box.ledger_damage = "its reports were recovered";
  snapshot.box.other_ledger = "ledger.sqlite";
  snapshot.box.put_aside = "the service ended 3 times";
  snapshot.box.disk.life = 10;
  snapshot.box.disk.wear_unknown = "life_time: Input/output error";
  snapshot.box.time_set = false;
  snapshot.box.stamps_ahead = 3 * 86400;
  snapshot.box.ntp_trouble = "ADDRESS does not answer";
  snapshot.box.change_trouble = "port 8000 is in use";
  snapshot.box.settings_trouble = snapshot.box.board_trouble = "an error in it";
  snapshot.box.lights_trouble = "no such device";
  snapshot.box.notices = {{"card", "what happened"}};
  snapshot.box.update = {.on_trial = true, .version = "1.2.0", .stray = "the last one did not come up"};
  days.push_back(named());
  days.back().box.stamps_damage = "their file is damaged";
  days.push_back(named());
  days.back().box.standby = "its spare takes over";
}

void the_network(std::vector<Snapshot>& days) {
  days.push_back(named());
  facts::Network& network = days.back().network;
  network.confirm_within = 88;
  network.page = "http://ADDRESS";
  network.no_address = true;
  network.taken = {{true, "team0", "ADDRESS", "another machine"}};
  days.push_back(named());
  for (EndpointRow& endpoint : days.back().traffic.endpoints) endpoint.fault = EndpointFault::Unreachable;
  days.back().network.exchanged = {"ADDRESS", "team0", "darpa0"};
  for (const std::optional<bool> carrier : {std::optional(false), std::optional<bool>()}) {
    days.push_back(named());
    for (facts::LinkRow& link : days.back().traffic.links) link.carrier = carrier;
  }
}

/// Each headline once, with its text for each side.
std::vector<Condition> all() {
  std::vector<Snapshot> days;
  for (const auto trouble :
       {EndpointFault::NoToken, EndpointFault::Unreachable, EndpointFault::Foreign, EndpointFault::Refusing,
        EndpointFault::Silent, EndpointFault::Failing, EndpointFault::Throttling}) {
    days.push_back(named());
    both_have(days.back(), trouble);
  }
  the_network(days);
  the_box(days);
  reports(days);
  robots_and_queue(days);
  std::vector<Condition> found;
  for (const Snapshot& day : days) {
    for (Condition& each : conditions_of(day)) {
      if (std::ranges::find(found, each.headline, &Condition::headline) == found.end())
        found.push_back(std::move(each));
    }
  }
  return found;
}

/// The kinds in tests/alarms/facts.txt: the words before the colon of each line.
std::set<std::string> kinds_with_tests() {
  std::set<std::string> kinds;
  std::istringstream lines(project_text("tests/alarms/facts.txt"));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line.substr(0, line.find(':')));
    for (std::string kind; words >> kind;) kinds.insert(kind);
  }
  return kinds;
}

/// The first cell of each kind's row in TROUBLE.md, by its first headline. The anchor is the kind.
std::string troubles(Side side) {
  constexpr std::string_view kSigns[] = {"■", "?", "○"};
  std::string cells;
  std::set<std::string> told;
  for (const Condition& each : all()) {
    if (each.side != side || !told.insert(kind_of(each.id)).second) continue;
    cells.append("| <a id=\"").append(kind_of(each.id)).append("\"></a>");
    cells.append(kSigns[static_cast<std::size_t>(each.severity)]);
    cells.append(" **").append(each.headline.now()).append("** |\n");
  }
  return cells;
}

TEST(AlarmsTroubles, HaveARowForEachKind) {
  const std::string page = project_text("firmware/rules/alarms/TROUBLE.md");
  for (std::size_t side = 0; side < std::size(kSideWords); ++side) {
    const std::string title = std::string("\n<!-- ") + std::string(kSideWords[side]) + " -->\n";
    const std::size_t from = page.find(title);
    std::string cells;
    std::istringstream lines(from == std::string::npos ? "" : page.substr(from + title.size()));
    for (std::string line; std::getline(lines, line) && !line.starts_with("<!-- ");) {
      if (!line.starts_with("| <a id=")) continue;
      cells.append(line, 0, line.find(" | ")).append(" |\n");
      EXPECT_EQ(std::ranges::count(line, '|'), 4) << "a row says what it means and what to do: " << line;
    }
    EXPECT_EQ(cells, troubles(static_cast<Side>(side))) << kSideWords[side];
  }
}

/// The Markdown between two marks as HTML: "**Settle**" as "<b>Settle</b>".
std::string with_tags(std::string text, std::string_view mark, const std::string& tag) {
  bool opens = true;
  for (std::size_t at = 0; (at = text.find(mark, at)) != std::string::npos; opens = !opens) {
    text.replace(at, mark.size(), (opens ? "<" : "</") + tag + ">");
  }
  return text;
}

/// "<b>HEADLINE</b>: REMEDY" of a row of TROUBLE.md, or "" if no row has the anchor.
std::string remedy_of(const std::string& troubles, std::string_view anchor) {
  const std::size_t from = troubles.find("| <a id=\"" + std::string(anchor) + "\"></a>");
  if (from == std::string::npos) return "";
  const std::string row = troubles.substr(from, troubles.find(" |\n", from) - from);
  const std::string headline = row.substr(row.find("**"), row.find("** |") + 2 - row.find("**"));
  return with_tags(with_tags(headline + ": " + row.substr(row.rfind(" | ") + 3), "**", "b"), "`", "code");
}

/// A row of the card has sentences of TROUBLE.md that follow each other there.
TEST(AlarmsCard, GivesTheRemediesOfTheTroubles) {
  const std::string troubles = project_text("firmware/rules/alarms/TROUBLE.md");
  std::istringstream card(project_text("board/card.html"));
  int count = 0;
  for (std::string line; std::getline(card, line);) {
    constexpr std::string_view kHead = "<li id=\"", kEnd = "</li>";
    if (!line.starts_with(kHead)) continue;
    const std::size_t after = line.find("\">");
    const std::string full =
        remedy_of(troubles, std::string_view(line).substr(kHead.size(), after - kHead.size()));
    const std::string row = line.substr(after + 2, line.size() - kEnd.size() - after - 2);
    const std::size_t colon = row.find("</b>: ") + 6;
    EXPECT_EQ(row.substr(0, colon), full.substr(0, colon)) << line;
    EXPECT_NE(full.find(row.substr(colon)), std::string::npos) << line << "\nbut TROUBLE.md says " << full;
    ++count;
  }
  EXPECT_GE(count, 20) << "the card helps in the field";
}

TEST(AlarmsTroubles, AreComplete) {
  std::set<std::string> made;
  for (const Condition& each : all()) made.insert(kind_of(each.id));
  EXPECT_EQ(made, kinds()) << "all() makes each condition";
  EXPECT_EQ(kinds_with_tests(), kinds()) << "tests/alarms/facts.txt";
}

}  // namespace
}  // namespace adit::alarms
