// Finds violations of promise 1 at the end of a world.
#include <algorithm>

#include "codec/read.hpp"
#include "dispatch/model/world.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch::model {
namespace {

/// A report posted so shortly before a new run may be meant for the new run.
constexpr Seconds kShortly = 25;

}  // namespace

std::vector<std::string> World::broken_promises() const {
  std::vector<std::string> broken = broken_;
  check_records(broken);
  check_ledger(broken);
  check_clients(broken);
  return broken;
}

bool World::was_recorded(double key) const {
  const auto all = recorded();
  return key >= 0 && std::ranges::find(all, key, &Recorded::key) != all.end();
}

/// By either Command Post.
std::vector<Recorded> World::recorded() const {
  std::vector<Recorded> all;
  for (const CommandPost& post : posts_there_) {
    all.insert(all.end(), post.recorded().begin(), post.recorded().end());
  }
  return all;
}

/// True if a client posted it during the run or shortly before, or while no run was known. A report without
/// a known run is for the first run that is heard of.
bool World::was_meant(const Recorded& record, std::size_t place) const {
  const auto client = std::ranges::find(clients_, record.key, &Client::key);
  return std::ranges::any_of(client->posted, [&](const Posting& posting) {
    if (posting.at <= first_heard_ || !posting.heard) return true;
    return posting.place == place && (posting.at >= record.run_began - kShortly || !trouble_.new_runs);
  });
}

/// Finds reports recorded twice in a run, or in a run that they were not meant for.
void World::check_records(std::vector<std::string>& broken) const {
  for (std::size_t place = 0; place < posts_there_.size(); ++place) {
    std::map<std::pair<double, std::int64_t>, std::vector<Recorded>> records;
    for (const Recorded& record : posts_there_[place].recorded()) {
      if (record.key >= 0) records[{record.key, record.run}].push_back(record);
    }
    for (const auto& [which, times] : records) {
      if (touched_.contains(which.first)) continue;
      // An unannounced administrative stop hides a record. A repeat costs nothing then.
      const auto scored = std::ranges::count_if(times, &Recorded::scored);
      const std::int64_t count = trouble_.admin_stops ? scored : static_cast<std::int64_t>(times.size());
      if (count > 1) {
        broken.push_back(icd::sentence("report ", which.first, " was recorded ", count, " times"));
      }
      // A new run is unknown until a status or an answer shows it.
      const bool unnoticed = trouble_.new_runs && times.front().at < times.front().run_began + kShortly;
      // A declared run without a status may be one that has not begun.
      const bool tells = trouble_.courses || (trouble_.new_runs && which.second > 1);
      if (tells && !was_meant(times.front(), place) && !unnoticed && !declared_) {
        broken.push_back(icd::sentence("report ", which.first, " was sent into run ", which.second,
                                       " at place ", place, " unasked"));
      }
    }
  }
}

/// Finds reports that are falsely recorded, have a wrong score, or are stuck.
void World::check_ledger(std::vector<std::string>& broken) const {
  const auto recorded = this->recorded();
  for (const auto& [number, report] : disk_.content().reports) {
    const double key = report.report.position.x;
    const std::string name = icd::sentence("report ", number, " of ", key, " is ", name_of(report.state));
    const bool claimed =
        report.state == ReportState::Answered || (report.state == ReportState::Settled && report.reconciled);
    // A record of another sender, or of a report that the operator decided, looks the same at that time.
    const bool blurred = std::ranges::any_of(recorded, [&](const Recorded& record) {
      const bool ours = record.key >= 0 && !touched_.contains(record.key);
      return !ours && record.at > report.sent - kEpoch - 60 && record.at < report.changed - kEpoch;
    });
    if (claimed && !was_recorded(key) && !blurred) broken.push_back(name + " and was never recorded");
    // Reports for another or absent Command Post stay queued.
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

/// Finds clients with a false 2xx.
void World::check_clients(std::vector<std::string>& broken) const {
  for (const Client& client : clients_) {
    if (client.acknowledged && !was_recorded(client.key) && others_.empty()) {
      broken.push_back(
          icd::sentence("client ", client.key, " was told that it was recorded, and it was not"));
    }
  }
}

}  // namespace adit::dispatch::model
