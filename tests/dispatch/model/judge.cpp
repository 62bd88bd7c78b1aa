// What broke promise 1 in a world that has come to rest.
#include <algorithm>

#include "codec/read.hpp"
#include "dispatch/model/world.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch::model {
namespace {

/// A report posted so shortly before a new run began may be meant for it.
constexpr Seconds kShortly = 25;

}  // namespace

std::vector<std::string> World::broken_promises() const {
  std::vector<std::string> broken = broken_;
  judge_records(broken);
  judge_ledger(broken);
  judge_clients(broken);
  return broken;
}

bool World::was_recorded(double key) const {
  return key >= 0 && std::ranges::find(post_.recorded(), key, &Recorded::key) != post_.recorded().end();
}

/// Recorded twice in a run, or in a run that it was not meant for.
void World::judge_records(std::vector<std::string>& broken) const {
  std::map<std::pair<double, std::int64_t>, std::vector<Recorded>> records;
  for (const Recorded& record : post_.recorded()) {
    if (record.key >= 0) records[{record.key, record.run}].push_back(record);
  }
  for (const auto& [which, times] : records) {
    if (touched_.contains(which.first)) continue;
    // In a stop that nobody told Adit of, a record does not show; it costs nothing there.
    const auto scored = std::ranges::count_if(times, &Recorded::scored);
    const std::int64_t count = trouble_.admin_stops ? scored : static_cast<std::int64_t>(times.size());
    if (count > 1) broken.push_back(icd::sentence("report ", which.first, " was recorded ", count, " times"));
    const auto client = std::ranges::find(clients_, which.first, &Client::key);
    // What came before anything was heard of a run is meant for the first that is.
    const bool meant = std::ranges::any_of(client->posted_at, [&](Seconds at) {
      return at >= times.front().run_began - kShortly || at <= first_heard_;
    });
    // Until a status or an answer tells, nobody knows that a run has begun.
    const bool unnoticed = times.front().at < times.front().run_began + kShortly;
    // A declared run of which no status was heard may be one that is still to begin.
    if (trouble_.new_runs && which.second > 1 && !meant && !unnoticed && !declared_) {
      broken.push_back(
          icd::sentence("report ", which.first, " was sent into run ", which.second, " unasked"));
    }
  }
}

/// Said to be recorded and was not, given a score that it has not, or left behind.
void World::judge_ledger(std::vector<std::string>& broken) const {
  for (const auto& [number, report] : disk_.content().reports) {
    const double key = report.report.position.x;
    const std::string name = icd::sentence("report ", number, " of ", key, " is ", name_of(report.state));
    const bool claimed =
        report.state == ReportState::Answered || (report.state == ReportState::Settled && report.reconciled);
    // What somebody else recorded at that very moment looks the same, be it another sender, or what the
    // operator judged; nobody could tell.
    const bool blurred = std::ranges::any_of(post_.recorded(), [&](const Recorded& record) {
      const bool ours = record.key >= 0 && !touched_.contains(record.key);
      return !ours && record.at > report.sent - kEpoch - 60 && record.at < report.changed - kEpoch;
    });
    if (claimed && !was_recorded(key) && !blurred) broken.push_back(name + " and was never recorded");
    if (report.state == ReportState::Waiting || report.state == ReportState::Sending) {
      broken.push_back(name + " though nothing was in its way");
    }
    const auto reply =
        report.reconciled ? codec::read_report_reply(report.answer) : std::unexpected<std::string>("");
    const auto is_true = [&](const Recorded& record) {
      return record.key == key && record.scored && record.points == reply->score_change;
    };
    if (reply && !blurred && std::ranges::none_of(post_.recorded(), is_true)) {
      broken.push_back(name + " with a score that is not true");
    }
  }
}

/// Told that it was recorded, and it was not.
void World::judge_clients(std::vector<std::string>& broken) const {
  for (const Client& client : clients_) {
    if (client.acknowledged && !was_recorded(client.key) && others_.empty()) {
      broken.push_back(
          icd::sentence("client ", client.key, " was told that it was recorded, and it was not"));
    }
  }
}

}  // namespace adit::dispatch::model
