#include "simulation/page_words.hpp"

#include <algorithm>
#include <map>

#include "icd/sentence.hpp"

namespace adit::simulation {
namespace {

using Json = nlohmann::json;

constexpr const char* kLights[] = {"health", "scoring", "mapping", "attention"};

/// The pattern in the table of panel/states.cpp, for a box whose cables are plugged in.
std::string pattern_of(const std::string& light, const Json& view) {
  if (!view.at("identify_until").is_null()) return "twice";
  const Json& alarms = view.at("alarms");
  if (light == "attention") {
    if (std::ranges::none_of(alarms, calls)) return "off";
    const auto is_new = [](const Json& alarm) { return calls(alarm) && !alarm.at("acknowledged"); };
    return std::ranges::any_of(alarms, is_new) ? "fast" : "on";
  }
  if (light == "health") {
    const auto is_of_ledger = [](const Json& alarm) { return alarm.at("id") == "ledger_unwritable"; };
    return std::ranges::any_of(alarms, is_of_ledger) ? "fast" : "on";
  }
  const auto row =
      std::ranges::find_if(view.at("endpoints"), [&](const Json& each) { return each.at("name") == light; });
  if (row->at("trouble") != "") return "fast";
  if (light == "scoring" && reports_in(view, "queued") > 0) return "slow";
  return row->at("connected") ? "on" : "off";
}

std::string status_line(const Json& view) {
  const Json& run = view.at("run");
  std::string line = run.is_null()
                         ? "no word from the Command Post yet"
                         : icd::sentence("score ", run.at("score").get<std::int64_t>(), ", ",
                                         run.at("remaining_reports").get<std::int64_t>(), " reports left");
  if (const auto waiting = reports_in(view, "queued"); waiting > 0)
    line += icd::sentence(", ", waiting, " reports queued");
  const Json& alarms = view.at("alarms");
  if (!alarms.empty() && calls(alarms.front())) line += "; " + alarm_line(alarms.front());
  return line;
}

const Event* last(const std::vector<Event>& events, std::size_t count, Kind kind, const std::string& what) {
  while (count-- > 0) {
    if (events[count].kind == kind && events[count].what == what) return &events[count];
  }
  return nullptr;
}

/// Compares the lights themselves: a steady light is on or off as the view says.
std::string lit(const Json& view, const std::string& bits) {
  std::size_t i = 0;
  for (const Json& light : view.at("lights")) {
    const std::string pattern = light.at("pattern"), name = light.at("name");
    const char bit = bits.at(i++);
    if ((pattern == "on" && bit != '1') || (pattern == "off" && bit != '0'))
      return icd::sentence("Lights: ", name, " is ", bit == '1' ? "lit" : "dark", ", but the view says ",
                           pattern);
  }
  return "";
}

}  // namespace

bool calls(const Json& alarm) {
  return alarm.at("severity") != "wait";
}

std::string alarm_line(const Json& alarm) {
  const std::string what = alarm.at("what"), why = alarm.at("why");
  return why.empty() ? what : what + ": " + why;
}

std::int64_t reports_in(const Json& view, const std::string& state) {
  return std::ranges::count_if(view.at("reports"), [&](const Json& row) {
    return row.at("state") == state && row.at("run") == view.at("run_number");
  });
}

std::string disagreement(const Json& view, const std::vector<Event>& events, std::size_t count) {
  for (const Json& light : view.at("lights")) {
    const std::string name = light.at("name"), expected = pattern_of(name, view), shown = light.at("pattern");
    if (shown != expected)
      return icd::sentence("Lights: ", name, " shows ", shown, ", but the rest of the view means ", expected);
  }
  const Event* const shown = last(events, count, Kind::Shows, "the panel");
  if (std::string wrong = shown == nullptr ? "Lights: no light was ever set" : lit(view, shown->who);
      !wrong.empty())
    return wrong;
  const Event* const told = last(events, count, Kind::Told, "STATUS");
  const std::string line = status_line(view);
  if (told == nullptr || told->text != line)
    return icd::sentence("Alive: STATUS is '", told == nullptr ? "" : told->text, "', but the view means '",
                         line, "'");
  return "";
}

}  // namespace adit::simulation
