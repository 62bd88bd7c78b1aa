// Honest, Lights and Alive: what Adit shows on the page and the panel and reports to systemd.
#include <algorithm>
#include <cmath>
#include <set>

#include "icd/sentence.hpp"
#include "simulation/checks.hpp"
#include "simulation/checks_metrics.hpp"
#include "simulation/courses.hpp"
#include "simulation/messages.hpp"
#include "simulation/page_account.hpp"
#include "simulation/page_words.hpp"
#include "simulation/scoreboard.hpp"
#include "simulation/upstream_view.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

using Json = nlohmann::json;
using Moment = PageAccount::Moment;

constexpr double kRests = 100;     // seconds after the last fault
constexpr double kHeartbeat = 10;  // seconds between two signs of life to systemd
constexpr double kAgeRounding = 0.05;
constexpr double kLongestSwitch = 12;  // seconds until a course is switched

Moment moment_of(const Reading& reading) {
  return {reading.asked, reading.heard};
}

/// A view's count for each stream. Grids and clouds of one robot count together.
std::map<Stream, std::int64_t> counts(const Json& view, const char* member) {
  std::map<Stream, std::int64_t> all;
  for (const Json& row : view.at("activities")) {
    const std::string kind = row.at("kind");
    const char* const path = kind == "state" ? kState : kind == "markers" ? kMarkers : kMap;
    all[stream_of(path, row.at("robot"))] += row.at(member).get<std::int64_t>();
  }
  return all;
}

/// The difference between two readings of one gateway.
class Difference {
 public:
  Difference(const PageAccount& account, const Reading& from, const Reading& to, Broken& broken)
      : account_(account), from_(from), to_(to), broken_(broken) {}

  void streams() {
    const Moment from = moment_of(from_), to = moment_of(to_);
    auto accepted = counts(from_.view, "accepted"), forwarded = counts(from_.view, "forwarded");
    for (const auto& [stream, count] : counts(to_.view, "accepted"))
      compare(stream.path + " of " + stream.who + " accepted", count - accepted[stream],
              account_.accepted(stream, from, to));
    for (const auto& [stream, count] : counts(to_.view, "forwarded"))
      compare(stream.path + " of " + stream.who + " forwarded", count - forwarded[stream],
              account_.forwarded(stream, from, to));
  }
  void endpoints() {
    const Moment from = moment_of(from_), to = moment_of(to_);
    for (std::size_t i = 0; i < to_.view.at("endpoints").size(); ++i) {
      const Json &now = to_.view.at("endpoints").at(i), &then = from_.view.at("endpoints").at(i);
      const std::string name = now.at("name");
      const auto grown = [&](const char* member) {
        return now.at(member).get<std::int64_t>() - then.at(member).get<std::int64_t>();
      };
      compare(name + ": throttled", grown("throttled"), account_.throttled(name, from, to));
      compare(name + ": foreign", grown("foreign"), account_.foreign(name, from, to));
    }
  }

 private:
  void compare(const std::string& what, std::int64_t shown, Range range) {
    if (range.has(shown)) return;
    broken_.push_back(icd::sentence("Honest: ", what, " ", shown, " times between ", from_.at, " and ",
                                    to_.at, " on the page, ", range.least, " to ", range.most,
                                    " times in the history"));
  }

  const PageAccount& account_;
  const Reading &from_, &to_;
  Broken& broken_;
};

/// A state's age is that of the oldest pose that the Command Post lacks, so no older than the newest that it
/// has. Without an age it has all.
void check_undelivered(const PageAccount& account, const Reading& reading, const Json& row, Broken& broken) {
  const Stream stream = stream_of(kState, row.at("robot").get<std::string>());
  const double most = account.age(stream, moment_of(reading)).most;
  const Json& shown = row.at("age").is_null() ? row.at("heard") : row.at("age");
  if (shown.is_null() || shown.get<double>() <= most + kAgeRounding) return;
  broken.push_back(icd::sentence("Honest: at ", reading.at, " the page shows an undelivered pose of ",
                                 stream.who, " of ", shown.get<double>(), " s, but the newest delivered is ",
                                 most, " s old"));
}

/// A robot's age is that of the last pose that the robot itself posted.
void check_ages(const Evidence& evidence, const PageAccount& account, const Reading& reading,
                Broken& broken) {
  const auto judge = [&](const Json& row, const std::string& robot) {
    const auto [least, most] = account.age(stream_of(kState, robot), moment_of(reading));
    const double age = row.at("age").is_null() ? HUGE_VAL : row.at("age").get<double>();
    if (age >= least - kAgeRounding && age <= most + kAgeRounding) return;
    broken.push_back(icd::sentence("Honest: at ", reading.at, " the page shows ", robot, " ", age,
                                   " s old, but it is ", least, " to ", most, " s"));
  };
  const auto is_set = [](const Event& event) {
    return event.kind == Kind::ClockSet || event.kind == Kind::PowerCut;
  };
  const auto heard = evidence.events.begin() + static_cast<std::ptrdiff_t>(reading.heard);
  if (std::any_of(evidence.events.begin(), heard, is_set)) return;
  for (const Json& row : reading.view.at("activities")) {
    if (row.at("kind") == "state") check_undelivered(account, reading, row, broken);
  }
  for (const Json& row : reading.view.at("robots")) judge(row, row.at("name"));
}

/// The last status of that Command Post that Adit read between two events.
const Event* last_status(const std::vector<Event>& events, std::size_t from, std::size_t to, int place) {
  while (to-- > from) {
    const Event& event = events[to];
    const bool is_status = event.kind == Kind::Replied && event.what == kStatus;
    if (is_status && event.status == 200 && !event.says.empty() && event.serial == place) return &event;
  }
  return nullptr;
}

/// Score, reports left and their age are those of the last status.
void check_run(const Evidence& evidence, std::size_t begun, const Reading& reading, Broken& broken) {
  const int place = place_at(reading.view.at("endpoints").front().at("address"));
  const Event* const heard = last_status(evidence.events, begun, reading.asked, place);
  if (heard != last_status(evidence.events, begun, reading.heard, place) || heard == nullptr) return;
  const Json status = Json::parse(heard->text), &run = reading.view.at("run");
  const auto differs = [&](const char* name) {
    return run.at(name).get<std::int64_t>() != status.at(name).get<std::int64_t>();
  };
  if (run.is_null() || differs("score") || differs("remaining_reports")) {
    broken.push_back(icd::sentence("Honest: at ", reading.at, " the page shows the run ", run.dump(),
                                   ", but the Command Post answered ", heard->text));
    return;
  }
  const double age = reading.view.at("run_clock").at("age").get<double>();
  const double asked = reading.at - heard->at, told = evidence.events[reading.heard - 1].at - heard->at;
  if (age < asked - kAgeRounding || age > told + kAgeRounding)
    broken.push_back(icd::sentence("Honest: at ", reading.at, " the page shows the status ", age,
                                   " s old, but it arrived at ", heard->at));
}

/// Another sender recorded a report meanwhile, which looks the same.
bool is_blurred(const Evidence& evidence, const Json& row) {
  const Window window =
      window_of(evidence, row.at("received").get<double>() - kLongestDoubt, row.at("changed").get<double>());
  const OlderCopies copies(evidence.events);
  return std::ranges::any_of(evidence.events, [&](const Event& event) {
    return is_anothers(event, copies) && window.has(World::kEpoch + event.at);
  });
}

/// A report that the page calls recorded is recorded, with the points shown.
void check_reports(const Evidence& evidence, const Reading& reading, Broken& broken) {
  for (const Json& row : reading.view.at("reports")) {
    const std::string state = row.at("state");
    if (row.at("position").is_null()) continue;
    if (state != "answered" && !(state == "settled" && row.at("reconciled"))) continue;
    const auto serial = std::llround(row.at("position").at("x").get<double>() / 100);
    bool recorded = false, right = row.at("score_change").is_null();
    for (std::size_t i = 0; i < reading.heard; ++i) {
      const Event& event = evidence.events[i];
      if (event.kind != Kind::Taken || event.what != kReports || event.serial != serial) continue;
      recorded = true;
      right = right || row.at("score_change") == std::llround(event.stamp);
    }
    if (!recorded && !is_blurred(evidence, row))
      broken.push_back(icd::sentence("Honest: at ", reading.at, " the page shows report ", serial, " ", state,
                                     ", but it is not recorded"));
    if (recorded && !right && !is_blurred(evidence, row))
      broken.push_back(
          icd::sentence("Honest: at ", reading.at, " the page shows report ", serial, " with a wrong score"));
  }
}

/// After a web page in place of the status, Adit tries the other form of the path. The page shows no answer
/// of a trial that failed.
class Trials {
 public:
  bool has_failed(const Event& event) {
    if (event.what != kStatus) return false;
    if (event.kind == Kind::Leaves) {
      sent_ = event.status;
      is_trial_ = is_page_ && sent_ != form_;
      if (!is_trial_) form_ = sent_;
    }
    if (event.kind != Kind::Replied) return false;
    if (!event.says.empty()) form_ = sent_;
    is_page_ = event.status / 100 == 2 && (event.who == kForeign || event.who == kTooLong);
    return is_trial_ && event.says.empty();
  }

 private:
  bool is_page_ = false, is_trial_ = false;
  int form_ = 0, sent_ = 0;  // the form in use, and that of the last request
};

/// If nothing is in flight, an endpoint's last status is that of its last answer, or `trouble` says why no
/// answer came.
void check_last_answers(const Evidence& evidence, std::size_t begun, const Reading& reading, Broken& broken) {
  std::map<std::string, std::string> under_way;  // path by endpoint
  std::map<std::string, const Event*> last;
  Trials trials;
  const int place = place_at(reading.view.at("endpoints").front().at("address"));
  for (std::size_t i = 0; i < reading.heard; ++i) {
    const Event& event = evidence.events[i];
    if (event.kind == Kind::Begins) trials = {};
    if (event.kind != Kind::Leaves && event.kind != Kind::Replied) continue;
    if (trials.has_failed(event) || i < begun) continue;
    const std::string endpoint = endpoint_of(event.what);
    if (event.kind == Kind::Leaves || (i >= reading.asked && event.kind == Kind::Replied))
      last[endpoint] = nullptr;
    if (event.kind == Kind::Replied && i < reading.asked && event.serial == place) last[endpoint] = &event;
  }
  for (const Json& row : reading.view.at("endpoints")) {
    if (row.at("name") != "scoring") continue;  // the mapping endpoint has two connections
    const Event* const heard = last["scoring"];
    const int status = row.at("last_status");
    const bool none = status == 0 && row.at("trouble") != "";  // the last request got no answer
    if (heard == nullptr || none || status == heard->status) continue;
    broken.push_back(icd::sentence("Honest: at ", reading.at, " the page shows scoring's last status ",
                                   row.at("last_status").dump(), ", but it was ", heard->status));
  }
}

/// Alarms of past events. "No room" for a message stays until the next message is accepted. A write that a
/// death tore in its last byte looks like a damaged byte. If the settings name robots, unknown senders stay
/// listed. Stopped robots and spent reports stay listed.
bool is_of_the_past(const Json& alarm) {
  const std::string id = alarm.at("id");
  constexpr std::string_view kOfThePast[] = {"map_not_kept",   "state_not_kept", "run_not_kept",
                                             "ledger_damaged", "wrong_tokens",   "robot_unknown",
                                             "robot_silent",   "robots_silent",  "reports_left"};
  return !calls(alarm) ||
         std::ranges::any_of(kOfThePast, [&](std::string_view begins) { return id.starts_with(begins); });
}

/// False if a process began so late that it may still ask about a doubt, or if one map takes longer to upload
/// than the rest lasts.
bool is_at_rest(const Evidence& evidence, const Reading& reading) {
  constexpr double kAsks = 30;    // seconds
  constexpr double kNoticed = 2;  // seconds until an ended alarm disappears
  bool is_under_way = false;
  double answered = 0;
  for (std::size_t i = 0; i < reading.heard; ++i) {
    const Event& event = evidence.events[i];
    if (event.kind == Kind::Begins && event.at > 0 && event.at + kAsks > reading.at) return false;
    if (event.what != kMap || event.actor != Actor::Adit) continue;
    if (event.kind == Kind::Leaves) is_under_way = true;
    if (event.kind != Kind::Replied) continue;
    is_under_way = false;
    answered = event.at;
  }
  return !is_under_way && answered + kNoticed < reading.at &&
         std::ranges::any_of(
             evidence.events,
             [&](const Event& event) { return event.kind == Kind::Calm && event.at + kRests < reading.at; });
}

/// Long after the last fault nothing is queued, and only what the operator must decide calls him.
void check_rest(const Evidence& evidence, const Reading& reading, Broken& broken) {
  for (const auto& [stream, count] : counts(reading.view, "queued")) {
    if (count > 0)
      broken.push_back(icd::sentence("Honest: at rest ", count, " of ", stream.path, " of ", stream.who,
                                     " are shown as queued"));
  }
  const auto& reports = reading.view.at("reports");
  const auto undecided = std::ranges::count_if(
      reports, [](const Json& row) { return row.at("state") == "held" || row.at("state") == "in_doubt"; });
  // A failed disk may have lost the last stamps, which stays told.
  const bool are_unwritten = std::ranges::any_of(evidence.events, [](const Event& event) {
    return event.kind == Kind::Said && event.text.contains("time stamps may run backward");
  });
  const auto called =
      static_cast<std::size_t>(std::ranges::count_if(reading.view.at("alarms"), [&](const Json& alarm) {
        return !is_of_the_past(alarm) && !(are_unwritten && alarm.at("id") == "stamps");
      }));
  // An alarm reports reports that Adit cannot account for.
  const bool beside = std::ranges::any_of(evidence.events, [](const Event& event) {
    const bool is_told = event.what != kSameMap && !event.who.ends_with(kNameless);
    const bool renames = event.kind == Kind::Fault && event.who == kRenames;
    return event.kind == Kind::Another || event.kind == Kind::PutBack || renames ||
           (event.kind == Kind::NewRun && !is_told);
  });
  if (called > 0 && undecided == 0 && !beside && reading.view.at("rejected").empty())
    broken.push_back(
        icd::sentence("Honest: at rest the operator is called: ", reading.view.at("alarms").dump()));
  constexpr std::int64_t kOneByOne = 10;  // more share one alarm
  if (called < static_cast<std::size_t>(std::min<std::int64_t>(undecided, kOneByOne)))
    broken.push_back(icd::sentence("Honest: at rest ", undecided,
                                   " reports need the operator, but alarms call him ", called, " times"));
}

/// What calls the operator names no field and no program, and his reasons are short.
void check_words(const Reading& reading, Broken& broken) {
  constexpr std::size_t kShort = 60;  // bytes
  const auto check = [&](const Json& row, const char* member) {
    const std::string text = row.at(member);
    for (const char* const word : {"aditd", "remaining_reports", "in_doubt"}) {
      if (text.contains(word))
        broken.push_back(icd::sentence("Honest: at ", reading.at, " the operator reads ", row.dump()));
    }
  };
  for (const Json& alarm : reading.view.at("alarms")) {
    check(alarm, "why");
    check(alarm, "details");
    const std::string id = alarm.at("id"), why = alarm.at("why");
    const bool are_ours = id.starts_with("report") || id.starts_with("run_");
    if (why.size() > kShort || (are_ours && why.ends_with("…")))
      broken.push_back(icd::sentence("Honest: at ", reading.at, " a reason is too long: ", alarm.dump()));
  }
  for (const Json& report : reading.view.at("reports")) check(report, "note");
}

/// Another course was requested just now, so the view's Command Post is unknown.
bool is_switching(const Evidence& evidence, const Reading& reading) {
  return std::ranges::any_of(evidence.events, [&](const Event& event) {
    return event.what == kCourse && event.at <= reading.at && event.at > reading.at - kLongestSwitch;
  });
}

}  // namespace

void honest(const Evidence& evidence, Broken& broken) {
  const PageAccount account(evidence.events);
  const Reading* before = nullptr;
  for (const Reading& reading : evidence.readings) {
    const std::size_t begun = account.begun(moment_of(reading));
    if (before != nullptr && begun <= before->asked && !is_switching(evidence, *before)) {
      Difference difference(account, *before, reading, broken);
      difference.streams();
      difference.endpoints();
    }
    before = &reading;
    if (begun > reading.asked || is_switching(evidence, reading)) continue;
    check_run(evidence, begun, reading, broken);
    check_ages(evidence, account, reading, broken);
    check_reports(evidence, reading, broken);
    check_words(reading, broken);
    check_last_answers(evidence, begun, reading, broken);
    check_metrics(evidence, reading, broken);
    if (reading.difference.starts_with("Honest")) broken.push_back(reading.difference);
  }
  if (!evidence.readings.empty() && is_at_rest(evidence, evidence.readings.back()))
    check_rest(evidence, evidence.readings.back(), broken);
}

void lights(const Evidence& evidence, Broken& broken) {
  for (const Reading& reading : evidence.readings) {
    if (reading.difference.starts_with("Lights"))
      broken.push_back(icd::sentence(reading.difference, ", at ", reading.at));
  }
}

void alive(const Evidence& evidence, Broken& broken) {
  double last = 0, slow = 0;  // seconds since then in which the process stood still for its disk
  bool ready = false, stopping = false, ended = false;
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Begins) {
      ready = stopping = ended = false;
      last = event.at;
    }
    if (event.kind == Kind::Ended) ended = true;  // messages that it sent before may still be heard
    if (event.kind == Kind::Stops) stopping = true;
    if (event.kind == Kind::Answered && event.status == 200 && !ready && !ended)
      broken.push_back(
          icd::sentence("Alive: ", event.what, " was answered 200 at ", event.at, ", before READY"));
    if (event.kind == Kind::Told && event.what == "STOPPING" && !stopping)
      broken.push_back(icd::sentence("Alive: STOPPING at ", event.at, ", without SIGTERM"));
    const bool sign = event.kind == Kind::Told && event.what == "WATCHDOG";
    const bool over = event.kind == Kind::Dies || event.kind == Kind::Ended;
    if (event.kind == Kind::Told && event.what == "READY") {
      if (!ready) last = event.at;
      ready = true;
    }
    if ((sign || over) && ready && event.at - last > kHeartbeat + slow)
      broken.push_back(icd::sentence("Alive: no sign of life between ", last, " and ", event.at));
    if (event.kind == Kind::Slow) slow += event.stamp;
    if (sign) {
      last = event.at;
      slow = 0;
    }
    if (over) ready = event.kind == Kind::Dies && ready;
  }
  for (const Reading& reading : evidence.readings) {
    if (reading.difference.starts_with("Alive"))
      broken.push_back(icd::sentence(reading.difference, ", at ", reading.at));
  }
}

}  // namespace adit::simulation
