// The alarms on the printable card (board/card.html), with the rules' current texts.
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <sstream>

#include "alarms/alike.hpp"
#include "project_files.hpp"

namespace adit::alarms {
namespace {

/// Two robots. One has a placeholder as its name.
Facts named() {
  Facts facts = well(1);
  for (Endpoint& endpoint : facts.endpoints) endpoint.address = "ADDRESS";
  facts.robots["NAME"] = {.gap = 1, .quiet = 1};
  facts.streams.push_back({.kind = "grid", .robot = "NAME", .forwarded = 1.0, .last_status = 200});
  return facts;
}

void both_have(Facts& facts, EndpointTrouble trouble) {
  for (Endpoint& endpoint : facts.endpoints) {
    endpoint.trouble = trouble;
    endpoint.said = trouble == EndpointTrouble::Failing ? "500" : "no route to host";
  }
}

void robots_and_queue(std::vector<Facts>& days) {
  days.push_back(named());
  days.back().robots["NAME"].silent = true;
  days.back().streams.back().behind = 100;
  days.back().streams.back().no_room = 1;
  days.back().unknown_robots = {"NAME"};
  days.back().known_robots = {"uav1"};
  days.back().crowds = {{CrowdFact::Is::NoRoom, "ADDRESS"},
                        {CrowdFact::Is::WrongToken, "ADDRESS"},
                        {CrowdFact::Is::Unauthenticated, "ADDRESS"}};
  days.back().shut_out = true;
  days.push_back(well(6));
  for (auto& [name, robot] : days.back().robots) robot.silent = true;
  for (Stream& stream : days.back().streams) stream.behind = 100;
  days.push_back(named());
  days.back().queued = days.back().queue_room;
  days.push_back(named());
  days.back().queue_grows = true;
  days.back().queued = 60u << 20;
}

void reports(std::vector<Facts>& days) {
  days.push_back(named());
  days.back().reports = {
      {.number = 7, .is = ReportFact::Is::Held, .note = "close to report 5"},
      {.number = 7, .is = ReportFact::Is::InDoubt, .note = "the status cannot tell"},
      {.number = 7, .is = ReportFact::Is::Lost, .of_run = false, .note = "a row is damaged"}};
  days.back().reports_left = 5;
  days.back().reports_elsewhere["ADDRESS"] = 2;
  days.back().run_unreliable = "somebody else reports with this token";
  days.back().run_renamed = "run 2, was 1";
  days.back().messages_rejected = 3;
  days.back().newest_rejected_why = "NAME's cloud: too large";
  days.push_back(named());
  days.back().reports_left = 0;
}

void the_box(std::vector<Facts>& days) {
  days.push_back(named());
  Facts& facts = days.back();
  facts.ledger_refusal = facts.disk.map = facts.disk.state = facts.disk.run = "no space";
  facts.ledger_damage = "its reports were recovered";
  facts.other_ledger = "ledger.sqlite";
  facts.put_aside = "aditd ended 3 times";
  facts.disk.free = 500u << 10;
  facts.disk.life = 10;
  facts.disk.wear_unknown = "life_time: Input/output error";
  facts.time_set = false;
  facts.stamps_ahead = 3 * 86400;
  facts.ntp_trouble = "ADDRESS does not answer";
  facts.change_trouble = "port 8000 is in use";
  facts.settings_trouble = facts.board_trouble = "an error in it";
  facts.lights_trouble = "no such device";
  facts.notices = {{"card", "what happened"}};
  facts.update = {.on_trial = true, .version = "1.2.0", .stray = "the last one did not come up"};
  days.push_back(named());
  days.back().stamps_damage = "their file is damaged";
  days.push_back(named());
  days.back().standby = "its spare takes over";
}

void the_network(std::vector<Facts>& days) {
  days.push_back(named());
  NetworkFact& network = days.back().network;
  network.confirm_within = 88;
  network.page = "http://ADDRESS";
  network.no_address = true;
  network.taken = {{true, "team0", "ADDRESS", "another machine"}};
  days.push_back(named());
  for (Endpoint& endpoint : days.back().endpoints) endpoint.trouble = EndpointTrouble::Unreachable;
  days.back().network.exchanged = {"ADDRESS", "team0", "darpa0"};
  for (const std::optional<bool> carrier : {std::optional(false), std::optional<bool>()}) {
    days.push_back(named());
    for (Cable& cable : days.back().cables) cable.carrier = carrier;
  }
}

/// Each headline once, with its text for each side.
std::vector<Condition> all() {
  std::vector<Facts> days;
  for (const auto trouble : {EndpointTrouble::NoToken, EndpointTrouble::Unreachable, EndpointTrouble::Foreign,
                             EndpointTrouble::Refusing, EndpointTrouble::Silent, EndpointTrouble::Failing,
                             EndpointTrouble::Throttling}) {
    days.push_back(named());
    both_have(days.back(), trouble);
  }
  the_network(days);
  the_box(days);
  reports(days);
  robots_and_queue(days);
  std::vector<Condition> found;
  for (const Facts& day : days) {
    for (Condition& each : conditions_of(day)) {
      if (std::ranges::find(found, each.headline, &Condition::headline) == found.end())
        found.push_back(std::move(each));
    }
  }
  return found;
}

std::string rows(Side side) {
  std::string html;
  for (const Condition& each : all()) {
    if (each.side != side) continue;
    html.append("<li class=\"").append(kSeverityWords[static_cast<std::size_t>(each.severity)]);
    html.append("\"><b>").append(each.headline.now()).append("</b>");
    if (!each.why.empty()) html.append(": ").append(each.why);
    if (!each.action.word.empty()) html.append(" <i>").append(each.action.word).append("</i>");
    html.append("</li>\n");
  }
  return html;
}

/// "no_token" of "no_token:scoring"
std::string kind_of(const std::string& id) {
  return id.substr(0, id.find(':'));
}

/// The kinds with a row in the README: the first kind of each row, and further ones in that cell.
std::set<std::string> kinds_in_readme() {
  const std::string text = project_text("firmware/rules/alarms/README.md");
  std::set<std::string> kinds;
  for (std::size_t at = text.find("\n| `"); at != std::string::npos; at = text.find("\n| `", at + 1)) {
    const std::string cell = text.substr(at + 3, text.find(" | ", at + 3) - at - 3);
    for (std::size_t name = cell.find('`'); name != std::string::npos; name = cell.find('`', name + 1)) {
      const std::string id = cell.substr(name + 1, cell.find('`', name + 1) - name - 1);
      if (!id.empty() && id[0] >= 'a' && id[0] <= 'z') kinds.insert(kind_of(id));
      name = cell.find('`', name + 1);
    }
  }
  return kinds;
}

TEST(AlarmsCard, NamesEachCondition) {
  const std::string card = project_text("board/card.html");
  for (std::size_t side = 0; side < std::size(kSideWords); ++side) {
    const std::string part = rows(static_cast<Side>(side));
    EXPECT_NE(card.find("<ul class=\"" + std::string(kSideWords[side]) + "\">\n" + part + "</ul>"),
              std::string::npos)
        << "put this into board/card.html:\n<ul class=\"" << kSideWords[side] << "\">\n"
        << part << "</ul>";
  }
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

TEST(AlarmsCard, IsComplete) {
  std::set<std::string> made;
  for (const Condition& each : all()) made.insert(kind_of(each.id));
  std::set<std::string> told = kinds_in_readme();
  EXPECT_GT(told.size(), 35u);
  for (const char* word : {"bad", "ask", "wait"}) told.erase(word);
  EXPECT_EQ(made, told);
}

}  // namespace
}  // namespace adit::alarms
