// Kept, Answered and HasRoom: what the team's clients heard.
#include <map>

#include "icd/sentence.hpp"
#include "simulation/checks.hpp"
#include "simulation/messages.hpp"

namespace adit::simulation {
namespace {

/// Seconds until a complete request is answered or its connection closed.
constexpr double kReportWithin = 21, kOtherWithin = 8;
/// The same for an incomplete request, from its last byte.
constexpr double kBodyWithin = 17, kHeadWithin = 62;

}  // namespace

void kept(const Evidence& evidence, Broken& broken) {
  std::map<std::uint64_t, double> began;
  double stopped = -1;
  int process = 0;
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Stops) {
      stopped = event.at;
      process = event.process;
    }
    if (event.kind == Kind::Invoke) began[event.request] = event.at;
    const bool taken = event.kind == Kind::Answered && event.status == 200 && event.what != kReports;
    if (taken && event.process == process && began[event.request] > stopped) {
      broken.push_back(icd::sentence("Kept: ", event.what, " ", event.serial, " of ", event.who,
                                     " arrived at ", began[event.request], ", after the stop at ", stopped,
                                     ", but was answered 200"));
    }
  }
}

void answered(const Evidence& evidence, Broken& broken) {
  std::map<std::uint64_t, std::pair<double, int>> whole;
  std::map<int, double> begun;
  bool is_on = false;
  double slow = 0, slow_until = 0;  // seconds that the box stood still for its disk, and until when
  std::map<std::uint64_t, double> slow_before;
  std::map<std::uint64_t, int> stalled;
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Begins) begun[event.process] = event.at;
    if (event.kind == Kind::Begins || event.kind == Kind::Ended) is_on = event.kind == Kind::Begins;
    if (event.kind == Kind::Slow) {
      slow += event.stamp;
      slow_until = event.at + event.stamp;
    }
    if (event.kind == Kind::Whole || event.kind == Kind::Stalls) {
      whole[event.request] = {event.at, event.process};
      slow_before[event.request] = slow - std::max(0.0, slow_until - event.at);
      if (event.kind == Kind::Stalls) stalled[event.request] = event.status;
    }
    if (event.kind != Kind::Answered && event.kind != Kind::Gone) continue;
    const auto asked = whole.find(event.request);
    if (asked == whole.end() || !is_on) continue;
    const double since =
        std::max(asked->second.first, begun[event.process]);  // it may have waited at the door
    const double rule = stalled[event.request] == kInBody   ? kBodyWithin
                        : stalled[event.request] == kInHead ? kHeadWithin
                        : event.what == kReports            ? kReportWithin
                                                            : kOtherWithin;
    const double within = rule + slow - slow_before[event.request];
    if (event.at - since > within) {
      broken.push_back(icd::sentence("Answered: ", event.what, " ", event.serial, " of ", event.who,
                                     " waited ", event.at - since, " s until ", event.at));
    }
  }
}

/// A client with a token never loses its connection to others. A flood is the exception, because it has
/// more connections than an address may have.
void has_room(const Evidence& evidence, Broken& broken) {
  for (const Event& event : evidence.events) {
    const bool is_sent_away =
        event.kind == Kind::Answered && event.status == 503 &&
        (event.text.contains("was closed for another") || event.text.contains("too many requests at once"));
    if (!is_sent_away || event.who == "flood") continue;
    broken.push_back(icd::sentence("HasRoom: ", event.what, " ", event.serial, " of ", event.who,
                                   " was rejected for others at ", event.at));
  }
}

}  // namespace adit::simulation
