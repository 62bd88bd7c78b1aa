#include "simulation/scoreboard.hpp"

#include <cstdio>

#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr int kSeenToRun = 4;       // statuses that Adit read
constexpr double kSeenToBeOn = 30;  // seconds until a new run may be noticed
/// Runs that Adit notices meanwhile are forgotten.
constexpr const char* kLedgerIsGone = "rejecting reports: the ledger cannot be ";

std::string json_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}

}  // namespace

Scoreboard::Scoreboard(World& world, const Faults& faults, Random& random, int place)
    : world_(world),
      faults_(faults),
      place_(place),
      numbers_runs_(random.chance(0.3)),
      run_began_(-random.uniform(300, 3000)) {
  const double drawn = world.random("names of runs " + std::to_string(place)).uniform(0, 1);
  names_ = drawn < 0.15 ? Names::One : drawn < 0.25 ? Names::Renamed : Names::Own;
}

bool Scoreboard::may_begin_run() const {
  const auto& events = world_.history().events();
  bool is_kept = true;
  int heard = 0;
  double shown = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = events[i];
    const bool is_said = event.kind == Kind::Said;
    if (event.kind == Kind::Begins) is_kept = true;
    if (is_said && event.text.contains(kLedgerIsGone)) is_kept = false;
    const bool is_heard = event.kind == Kind::Replied && event.what == kStatus && event.status == 200 &&
                          event.serial == place_ && event.says.size() == 3;
    if (i < run_begins_ || !is_kept || !is_heard) continue;
    ++heard;
    shown = event.says[2] / 1000.0;
  }
  return heard >= kSeenToRun && shown >= kSeenToBeOn;
}

void Scoreboard::begin_run() {
  ++run_;
  remaining_ = 25;
  score_ = 0;
  run_began_ = world_.time();
  stopped_ = false;
  world_.note({.actor = Actor::Post,
               .kind = Kind::NewRun,
               .what = "",
               .who = run_name(place_, run_) + (faults_.has(Fault::NamelessRuns) ? kNameless : ""),
               .serial = run_});
  run_begins_ = world_.history().events().size();
}

void Scoreboard::set_clock_back() {
  constexpr double kBy = 60;  // seconds
  if (world_.time() - run_began_ < kBy + kSeenToBeOn) return;
  run_began_ += kBy;
  world_.note({.actor = Actor::Post, .kind = Kind::Fault, .what = kStatus, .who = kSetBack});
  run_begins_ = world_.history().events().size();
}

void Scoreboard::grant_report() {
  ++remaining_;
  world_.note({.actor = Actor::Post, .kind = Kind::NewRun, .what = kSameMap, .who = name(), .serial = run_});
  run_begins_ = world_.history().events().size();
}

/// The name of the run in an answer.
std::string Scoreboard::told_name() {
  if (faults_.has(Fault::ConstantClocks) || names_ == Names::One) return "1";
  if (names_ == Names::Own) return std::to_string(run_);
  if (id_ > 1 && !faults_.has(Fault::NamelessRuns)) {
    world_.note({.actor = Actor::Post, .kind = Kind::Fault, .what = kReports, .who = kRenames});
  }
  return std::to_string(id_);
}

std::string Scoreboard::status() {
  const double clock = faults_.has(Fault::ConstantClocks) ? 25.98 : world_.time() - run_began_;
  return http_answer("200 OK", kJson,
                     "{\"score\": " + std::to_string(score_) + ", \"run_clock\": " + json_number(clock) +
                         ", \"remaining_reports\": " + std::to_string(remaining_) +
                         ", \"current_team\": \"adit\"}");
}

/// Counts one more report.
const char* Scoreboard::score(int points) {
  if (stopped_) return "admin stop";
  if (remaining_ == 0) return "report limit exceeded";
  --remaining_;
  score_ += points;
  return kScored;
}

std::string Scoreboard::record(const Item& item, const HttpMessage& request) {
  const bool counts = remaining_ > 0 && !stopped_;
  const int points = counts && item.serial % 3 == 1 ? 1 : 0;
  const char* const state = score(points);
  world_.note({.actor = Actor::Post,
               .kind = Kind::Taken,
               .what = kReports,
               .who = name() + (stopped_ ? kInAStop : ""),
               .serial = item.serial,
               .stamp = static_cast<double>(points)});
  last_ = item.serial;
  return last_answer_ = reply(request.body, state, points);
}

std::optional<std::string> Scoreboard::last_answer(const Item& item) const {
  if (last_ == 0 || last_ == item.serial) return std::nullopt;
  return last_answer_;
}

void Scoreboard::record_another() {
  score(0);
  world_.note({.actor = Actor::Post, .kind = Kind::Another, .what = kReports, .who = name()});
}

std::string Scoreboard::reply(const std::string& report, const char* state, int points) {
  const bool stands = faults_.has(Fault::ConstantClocks);
  const double clock = stands ? 3.14 : world_.time() - run_began_;
  const std::int64_t id = ++id_;
  const std::string name = told_name();
  std::string run = faults_.has(Fault::NamelessRuns) ? ""
                    : numbers_runs_                  ? "\"run\": " + name + ", "
                                                     : "\"run\": \"" + name + "\", ";
  // The report as it was sent, without its last brace.
  return http_answer("201 Created", kJson,
                     report.substr(0, report.rfind('}')) + ", \"url\": \"\", \"id\": " + std::to_string(id) +
                         ", " + run + "\"team\": \"adit\", \"run_clock\": " + json_number(clock) +
                         ", \"report_status\": \"" + state +
                         "\", \"score_change\": " + std::to_string(points) + "}");
}

std::string run_name(int place, std::int64_t run) {
  return (place == 0 ? "run " : "other run ") + std::to_string(run);
}

}  // namespace adit::simulation
