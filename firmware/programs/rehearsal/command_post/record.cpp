#include "rehearsal/command_post/record.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>

namespace adit::rehearsal {
namespace {

constexpr std::size_t kMostParts = 1000;
constexpr std::size_t kMostFaults = 1000;
constexpr std::size_t kMostReports = 10'000;
constexpr std::size_t kMostViolations = 200;
constexpr std::size_t kLongest = 200;  // characters of a name or sentence
constexpr const char* kOthers = "(others)";

/// Robots' names come from the wire: nothing of them may steer a terminal.
std::string printable(const std::string& text) {
  std::string safe = text.substr(0, kLongest);
  for (char& c : safe) {
    if (c < 0x20 || c == 0x7f) c = '?';
  }
  return safe;
}

}  // namespace

void Record::note_part(const std::string& uri, const Accepted& part) {
  const Part key{uri, part.kind, part.robot.substr(0, kLongest)};
  const bool room = accepted_.size() < kMostParts || accepted_.contains(key);
  ++accepted_[room ? key : Part{uri, part.kind, kOthers}];
}

void Record::note(std::uint64_t number, const Judgement& judgement) {
  const std::lock_guard lock(mutex_);
  const bool answered = judgement.outcome.kind == Outcome::Kind::Answered;
  const std::string uri = judgement.uri.empty() ? kOthers : judgement.uri;
  ++requests_[{uri, answered ? judgement.outcome.answer.status : 0}];
  for (const Accepted& part : judgement.accepted) note_part(uri, part);
  if (!judgement.fault.empty()) {
    const std::pair key{uri, judgement.fault};
    const bool room = faults_.size() < kMostFaults || faults_.contains(key);
    ++faults_[room ? key : UriAndFault{uri, kOthers}];
  }
  for (std::string& sentence : judgement.findings.violations()) {
    ++violation_count_;
    if (violations_.size() < kMostViolations) violations_.push_back({number, uri, std::move(sentence)});
  }
  if (judgement.outcome.kind == Outcome::Kind::Dies && killed_by_.empty()) {
    killed_by_ = judgement.findings.decisive(Manner::AsMeasured)->sentence;
  }
}

void Record::note_report(const OrderedJson& report) {
  const auto id_of = [](const OrderedJson& one) { return one["id"].get<std::int64_t>(); };
  const std::lock_guard lock(mutex_);
  ++report_count_;
  auto place = reports_.end();
  while (place != reports_.begin() && id_of(*std::prev(place)) > id_of(report)) --place;
  reports_.insert(place, report);
  if (reports_.size() > kMostReports) reports_.pop_front();
}

std::string Record::killed_by() const {
  const std::lock_guard lock(mutex_);
  return killed_by_;
}

OrderedJson Record::counts() const {
  OrderedJson requests = OrderedJson::array();
  for (const auto& [key, count] : requests_) {
    requests.push_back({{"uri", key.first}, {"status", key.second}, {"count", count}});
  }
  OrderedJson accepted = OrderedJson::array();
  for (const auto& [part, count] : accepted_) {
    const auto& [uri, kind, robot] = part;
    accepted.push_back({{"uri", uri}, {"kind", kind}, {"robot", robot}, {"count", count}});
  }
  OrderedJson faults = OrderedJson::array();
  for (const auto& [key, count] : faults_) {
    faults.push_back({{"uri", key.first}, {"fault", key.second}, {"count", count}});
  }
  return {{"requests", requests}, {"accepted", accepted}, {"faults", faults}};
}

OrderedJson Record::json(const Run::Standing& standing) const {
  const std::lock_guard lock(mutex_);
  OrderedJson first = OrderedJson::array();
  for (const Violation& violation : violations_) {
    first.push_back(
        {{"request", violation.number}, {"uri", violation.uri}, {"sentence", violation.sentence}});
  }
  OrderedJson killed;
  if (!killed_by_.empty()) killed = killed_by_;
  OrderedJson record = {{"manner", manner_ == Manner::Strict ? "strict" : "as measured"},
                        {"team", standing.team},
                        {"run", standing.run},
                        {"state", standing.state},
                        {"run_clock", standing.clock},
                        {"score", standing.score},
                        {"remaining_reports", standing.remaining_reports}};
  record.update(counts());
  record.update({{"report_count", report_count_},
                 {"reports", reports_},
                 {"violation_count", violation_count_},
                 {"violations", first},
                 {"killed_by", killed}});
  return record;
}

std::string Record::summary(const Run::Standing& standing) const {
  constexpr std::size_t most_lines = 50;
  const std::lock_guard lock(mutex_);
  std::ostringstream out;
  out << "summary: team " << standing.team << ", run " << standing.run << ", " << standing.state
      << ", run clock " << standing.clock << " s\n";
  for (const auto& [key, count] : requests_) {
    out << "  " << key.first << ": " << (key.second == 0 ? "not answered" : std::to_string(key.second))
        << " x " << count << "\n";
  }
  out << "accepted\n";
  for (const auto& [part, count] : accepted_) {
    const auto& [uri, kind, robot] = part;
    out << "  " << kind << " " << (robot.empty() ? "-" : printable(robot)) << ": " << count << "\n";
  }
  out << "reports: " << report_count_ << ", score " << standing.score << ", " << standing.remaining_reports
      << " remaining\n";
  const std::size_t skipped = reports_.size() > most_lines ? reports_.size() - most_lines : 0;
  for (std::size_t i = skipped; i < reports_.size(); ++i) {
    const OrderedJson& report = reports_[i];
    out << "  #" << report["id"] << " at " << report["run_clock"]
        << " s: " << printable(line_of(report["type"])) << " (" << printable(line_of(report["x"])) << ", "
        << printable(line_of(report["y"])) << ", " << printable(line_of(report["z"])) << ") "
        << report["report_status"].get<std::string>() << ", " << report["score_change"]
        << (report["by"] == kByOther ? ", by another sender\n" : "\n");
  }
  if (!faults_.empty()) out << "requested faults\n";
  for (const auto& [key, count] : faults_) {
    out << "  " << key.first << ": " << key.second << " (" << count << " times)\n";
  }
  out << "violations of the ICD: " << violation_count_ << "\n";
  std::map<std::pair<std::string, std::string>, std::uint64_t> alike;
  for (const Violation& violation : violations_) ++alike[{violation.uri, violation.sentence}];
  for (const auto& [what, count] : alike) {
    out << "  " << what.first << ": " << printable(what.second) << " (" << count << " times)\n";
  }
  if (!killed_by_.empty()) out << "killed by " << printable(killed_by_) << "\n";
  return out.str();
}

}  // namespace adit::rehearsal
