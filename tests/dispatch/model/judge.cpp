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
  const auto all = recorded();
  return key >= 0 && std::ranges::find(all, key, &Recorded::key) != all.end();
}

/// By any Command Post.
std::vector<Recorded> World::recorded() const {
  std::vector<Recorded> all;
  for (const CommandPost& post : posts_there_) {
    all.insert(all.end(), post.recorded().begin(), post.recorded().end());
  }
  return all;
}

/// Somebody posted it when the run was on, or shortly before; or when nothing was known of any run: then it
/// is meant for the first that is heard of.
bool World::was_meant(const Recorded& record, std::size_t place) const {
  const auto client = std::ranges::find(clients_, record.key, &Client::key);
  return std::ranges::any_of(client->posted, [&](const Posting& posting) {
    if (posting.at <= first_heard_ || !posting.heard) return true;
    return posting.place == place && (posting.at >= record.run_began - kShortly || !trouble_.new_runs);
  });
}

/// Recorded twice in a run, or in a run that it was not meant for.
void World::judge_records(std::vector<std::string>& broken) const {
  for (std::size_t place = 0; place < posts_there_.size(); ++place) {
    std::map<std::pair<double, std::int64_t>, std::vector<Recorded>> records;
    for (const Recorded& record : posts_there_[place].recorded()) {
      if (record.key >= 0) records[{record.key, record.run}].push_back(record);
    }
    for (const auto& [which, times] : records) {
      if (touched_.contains(which.first)) continue;
      // In a stop that nobody told Adit of, a record does not show; it costs nothing there.
      const auto scored = std::ranges::count_if(times, &Recorded::scored);
      const std::int64_t count = trouble_.admin_stops ? scored : static_cast<std::int64_t>(times.size());
      if (count > 1) {
        broken.push_back(icd::sentence("report ", which.first, " was recorded ", count, " times"));
      }
      // Until a status or an answer tells, nobody knows that a run has begun.
      const bool unnoticed = trouble_.new_runs && times.front().at < times.front().run_began + kShortly;
      // A declared run of which no status was heard may be one that is still to begin.
      const bool tells = trouble_.courses || (trouble_.new_runs && which.second > 1);
      if (tells && !was_meant(times.front(), place) && !unnoticed && !declared_) {
        broken.push_back(icd::sentence("report ", which.first, " was sent into run ", which.second,
                                       " at place ", place, " unasked"));
      }
    }
  }
}

/// Said to be recorded and was not, given a score that it has not, or left behind.
void World::judge_ledger(std::vector<std::string>& broken) const {
  const auto recorded = this->recorded();
  for (const auto& [number, report] : disk_.content().reports) {
    const double key = report.report.position.x;
    const std::string name = icd::sentence("report ", number, " of ", key, " is ", name_of(report.state));
    const bool claimed =
        report.state == ReportState::Answered || (report.state == ReportState::Settled && report.reconciled);
    // What somebody else recorded at that very moment looks the same, be it another sender, or what the
    // operator judged; nobody could tell.
    const bool blurred = std::ranges::any_of(recorded, [&](const Recorded& record) {
      const bool ours = record.key >= 0 && !touched_.contains(record.key);
      return !ours && record.at > report.sent - kEpoch - 60 && record.at < report.changed - kEpoch;
    });
    if (claimed && !was_recorded(key) && !blurred) broken.push_back(name + " and was never recorded");
    // What waits for another Command Post is kept for it; where nobody is, nothing goes.
    const auto runs = disk_.content().runs;
    const bool waits = report.state == ReportState::Queued &&
                       (!is_anybody_there() || runs.at(report.run).post != reports_->run().post);
    if (!waits && (report.state == ReportState::Queued || report.state == ReportState::Sending)) {
      broken.push_back(name + " though nothing was in its way");
    }
    const auto reply =
        report.reconciled ? codec::read_report_reply(report.answer) : std::unexpected<std::string>("");
    const auto is_true = [&](const Recorded& record) {
      return record.key == key && record.scored && record.points == reply->score_change;
    };
    if (reply && !blurred && std::ranges::none_of(recorded, is_true)) {
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
