#include "ledger/book.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>

#include "codec/row.hpp"
#include "icd/sentence.hpp"
#include "store/frame.hpp"

namespace adit {

namespace ledger {

/// The member at a path of pointers to members, and its name for people.
template <auto first, auto... rest>
struct MemberPath {
  const char* name;

  auto& operator()(auto& of) const { return ((of.*first).*....*rest); }
};

}  // namespace ledger

// The members of reports and runs. Append new ones, which earlier versions preserve and their records lack.

template <>
inline constexpr auto store::kMembers<dispatch::Report> = [] {
  using dispatch::Report, icd::ArtifactReport, ledger::MemberPath;
  return std::tuple(
      MemberPath<&Report::number>{"number"}, MemberPath<&Report::report, &ArtifactReport::type>{"type"},
      MemberPath<&Report::report, &ArtifactReport::position, &icd::Point::x>{"x"},
      MemberPath<&Report::report, &ArtifactReport::position, &icd::Point::y>{"y"},
      MemberPath<&Report::report, &ArtifactReport::position, &icd::Point::z>{"z"},
      MemberPath<&Report::report, &ArtifactReport::robot>{"robot"}, MemberPath<&Report::sender>{"sender"},
      MemberPath<&Report::received>{"received"}, MemberPath<&Report::changed>{"changed"},
      MemberPath<&Report::state>{"state"}, MemberPath<&Report::note>{"note"}, MemberPath<&Report::run>{"run"},
      MemberPath<&Report::asked>{"asked"}, MemberPath<&Report::same_as>{"same_as"},
      MemberPath<&Report::tries>{"tries"}, MemberPath<&Report::sending>{"sending"},
      MemberPath<&Report::sent>{"sent"}, MemberPath<&Report::before>{"before"},
      MemberPath<&Report::status>{"status"}, MemberPath<&Report::content_type>{"content_type"},
      MemberPath<&Report::answer>{"answer"}, MemberPath<&Report::reconciled>{"reconciled"},
      MemberPath<&Report::beside>{"beside"}, MemberPath<&Report::counted>{"counted"},
      MemberPath<&Report::uncertain>{"uncertain"});
}();
/// The members of `report` and of its position are among them.
template <>
inline constexpr std::size_t store::kMemberCount<dispatch::Report> =
    icd::count_of_members<dispatch::Report>() - 1 + icd::count_of_members<icd::ArtifactReport>() - 1 +
    icd::count_of_members<icd::Point>();
template <>
inline constexpr auto store::kMembers<dispatch::Run> = [] {
  using dispatch::Run, ledger::MemberPath;
  return std::tuple(
      MemberPath<&Run::number>{"number"}, MemberPath<&Run::id>{"id"}, MemberPath<&Run::began>{"began"},
      MemberPath<&Run::why>{"why"}, MemberPath<&Run::last>{"last"}, MemberPath<&Run::heard>{"heard"},
      MemberPath<&Run::post>{"post"}, MemberPath<&Run::unreliable>{"unreliable"},
      MemberPath<&Run::turn>{"turn"}, MemberPath<&Run::may_be>{"may_be"},
      MemberPath<&Run::status_clock>{"status_clock"}, MemberPath<&Run::answer_clock>{"answer_clock"},
      MemberPath<&Run::signs>{"signs"}, MemberPath<&Run::name_trouble>{"name_trouble"});
}();
template <>
inline constexpr auto store::kMembers<dispatch::Clock> = std::tuple(
    ledger::MemberPath<&dispatch::Clock::shows>{"shows"}, ledger::MemberPath<&dispatch::Clock::runs>{"runs"});
template <>
inline constexpr auto store::kMembers<dispatch::Signs> = std::tuple(
    ledger::MemberPath<&dispatch::Signs::count>{"count"},
    ledger::MemberPath<&dispatch::Signs::clock>{"clock"},
    ledger::MemberPath<&dispatch::Signs::score>{"score"}, ledger::MemberPath<&dispatch::Signs::name>{"name"});
template <>
inline constexpr auto store::kMembers<icd::RunStatus> =
    std::tuple(&icd::RunStatus::score, &icd::RunStatus::run_clock, &icd::RunStatus::remaining_reports,
               &icd::RunStatus::current_team);
template <>
inline constexpr auto store::kMembers<ledger::Step> =
    std::tuple(&ledger::Step::at, &ledger::Step::state, &ledger::Step::note);
template <>
inline constexpr auto store::kMembers<ledger::Steps::Entry> =
    std::tuple(&ledger::Steps::Entry::report, &ledger::Steps::Entry::history);
template <>
inline constexpr auto store::kMembers<ledger::Steps> =
    std::tuple(&ledger::Steps::highest, &ledger::Steps::reports, &ledger::Steps::runs);

namespace ledger {
namespace {

using dispatch::Report;
using dispatch::ReportState;
using dispatch::Run;

class RecordWriter : public store::Writer {
 public:
  using store::Writer::operator();
  void operator()(ReportState state) { (*this)(dispatch::name_of(state)); }
  void operator()(const std::optional<icd::RobotName>& robot) { (*this)(icd::text_of(robot)); }
};

class RecordReader : public store::Reader {
 public:
  using store::Reader::Reader, store::Reader::operator();
  void operator()(ReportState& state) {
    const auto word = read<std::string_view>();
    const auto* const known = std::ranges::find(dispatch::kStateWords, word);
    if (known == std::end(dispatch::kStateWords)) unknown_ = word;
    state = unknown_.empty() ? static_cast<ReportState>(known - std::begin(dispatch::kStateWords))
                             : ReportState::InDoubt;
  }
  void operator()(std::optional<icd::RobotName>& robot) {
    robot = icd::RobotName::parse(read<std::string_view>());
  }

  /// The word of a state unknown to this version, or "".
  std::string_view unknown_state() const { return unknown_; }

 private:
  std::string_view unknown_;
};

/// A value of a record for people.
template <class Of>
codec::Value show(const Of& of) {
  if constexpr (std::same_as<Of, ReportState>) {
    return {std::string(dispatch::name_of(of))};
  } else if constexpr (std::same_as<Of, std::optional<icd::RobotName>>) {
    return {icd::text_of(of)};
  } else if constexpr (std::same_as<Of, std::optional<dispatch::Clock>>) {
    return of ? show(*of) : codec::Value();
  } else if constexpr (requires { codec::KindOf<Of>::write(of); }) {
    return codec::json(of);
  } else {
    codec::Value::Object members;
    const auto add = [&](const auto& member) { members.emplace_back(member.name, show(member(of))); };
    std::apply([&](const auto&... each) { (add(each), ...); }, store::kMembers<Of>);
    return {std::move(members)};
  }
}

/// The number of the members that version 0.1.0 wrote.
template <class Of>
constexpr std::size_t kOldestMembers = 0;
template <>
constexpr std::size_t kOldestMembers<Report> = 25;
template <>
constexpr std::size_t kOldestMembers<Run> = 14;

template <class Of>
std::optional<Of> read_record(std::string_view record) {
  RecordReader take(record);
  Of what;
  store::read_first_members<kOldestMembers<Of>>(take, what);
  if (!take.ok() || what.number < 1) return std::nullopt;
  if constexpr (std::same_as<Of, Report>) {
    if (!take.unknown_state().empty()) {  // without `before`, only the operator may decide on it
      what.note =
          "its state '" + std::string(take.unknown_state()) + "' is unknown to this version; " + what.note;
      what.before.reset();
      what.counted = false;
    }
  }
  return what;
}

template <class Of>
std::string_view rest_of(std::string_view record) {
  RecordReader take(record);
  Of what;
  store::read_first_members<kOldestMembers<Of>>(take, what);
  return take.remaining();
}

}  // namespace

std::string to_bytes(const Report& report, std::string_view more) {
  return store::bytes_of<RecordWriter>(report).append(more);
}

std::string to_bytes(const Run& run, std::string_view more) {
  return store::bytes_of<RecordWriter>(run).append(more);
}

std::optional<Report> report_in(std::string_view record) {
  return read_record<Report>(record);
}

std::optional<Run> run_in(std::string_view record) {
  return read_record<Run>(record);
}

std::string_view more_of_report(std::string_view record) {
  return rest_of<Report>(record);
}

std::string_view more_of_run(std::string_view record) {
  return rest_of<Run>(record);
}

codec::Value to_value(const Report& report) {
  return show(report);
}

codec::Value to_value(const Run& run) {
  return show(run);
}

std::string to_bytes(const Step& step) {
  return store::bytes_of(step);
}

std::string step_of(const Report& report) {
  return to_bytes(Step{report.changed, std::string(dispatch::name_of(report.state)), report.note});
}

std::optional<std::vector<Step>> steps_in(std::string_view record) {
  std::vector<Step> steps;
  store::Reader reader(record);
  while (reader.ok() && !reader.is_at_end()) steps.push_back(reader.read<Step>());
  return reader.ok() ? std::optional(std::move(steps)) : std::nullopt;
}

std::string to_bytes(const Steps& steps) {
  return store::bytes_of(steps);
}

std::optional<Steps> steps_record_in(std::string_view record) {
  Steps steps;
  const auto is_entry = [](const Steps::Entry& entry) {
    return report_in(entry.report) && steps_in(entry.history);
  };
  const bool is_whole = store::read(record, steps) && std::ranges::all_of(steps.reports, is_entry) &&
                        std::ranges::all_of(steps.runs, [](std::string_view run) { return !!run_in(run); });
  return is_whole ? std::optional(std::move(steps)) : std::nullopt;
}

namespace {

using dispatch::Run;
using store::Error;

constexpr std::uint8_t kSteps = static_cast<std::uint8_t>(RecordKind::Steps);

std::string step_context(std::int64_t number) {
  return "recording a step of report " + std::to_string(number);
}

bool is_number(const std::optional<icd::RunStatus>& status) {
  return !status || !std::isnan(status->run_clock);
}

bool is_number(const Report& report) {
  const icd::Point& at = report.report.position;
  return !std::isnan(at.x) && !std::isnan(at.y) && !std::isnan(at.z) && is_number(report.before);
}

/// Compares the data of a report that never changes.
bool is_same(const Report& one, const Report& other) {
  const icd::Point &at = one.report.position, &there = other.report.position;
  return one.report.type == other.report.type && at.x == there.x && at.y == there.y && at.z == there.z &&
         one.received == other.received;
}

}  // namespace

bool Book::apply(std::uint8_t kind, std::string_view body) {
  if (kind != kSteps) {
    unknown_.emplace_back(kind, body);
    return true;
  }
  const auto steps = steps_record_in(body);
  if (!steps) return false;
  highest_ = std::max(highest_, steps->highest);
  for (const Steps::Entry& entry : steps->reports) {
    const std::int64_t number = report_in(entry.report)->number;
    StoredReport& kept = reports_[number];
    kept.record = entry.report;
    kept.history += entry.history;
    highest_ = std::max(highest_, number);
  }
  for (const std::string_view run : steps->runs) runs_[run_in(run)->number] = run;
  return true;
}

std::vector<std::pair<std::uint8_t, std::string>> Book::records() const {
  auto records = unknown_;
  for (const auto& [number, kept] : reports_) {
    records.emplace_back(
        kSteps, to_bytes(Steps{.highest = highest_, .reports = {{kept.record, kept.history}}, .runs = {}}));
  }
  for (const auto& [number, run] : runs_)
    records.emplace_back(kSteps, to_bytes(Steps{.highest = highest_, .reports = {}, .runs = {run}}));
  return records;
}

std::string Book::record_of(const Reports& reports, const Runs& runs) const {
  Steps all{.highest = highest_, .reports = {}, .runs = {}};
  for (const auto& [number, kept] : reports) {
    all.highest = std::max(all.highest, number);
    all.reports.push_back({kept.record, kept.history});
  }
  for (const auto& [number, run] : runs) all.runs.push_back(run);
  return to_bytes(all);
}

store::Result<std::string> Book::record(std::span<const Report> steps, const Run* run) const {
  Reports written;
  for (const Report& step : steps) {
    StoredReport& kept = written[step.number];
    if (const auto known = reports_.find(step.number); kept.record.empty() && known != reports_.end())
      kept.record = known->second.record;
    if (step.number < 1 || !is_number(step))
      return std::unexpected(Error{.what = step_context(step.number) + ": a value is not a number"});
    if (!kept.record.empty() && !is_same(*report_in(kept.record), step))
      return std::unexpected(Error{.what = step_context(step.number) + ": another report has this number"});
    kept.record = to_bytes(step, more_of_report(kept.record));
    kept.history += step_of(step);
  }
  if (run != nullptr && (run->number < 1 || !is_number(run->last)))
    return std::unexpected(
        Error{.what = "recording run " + std::to_string(run->number) + ": a value is not a number"});
  Runs runs;
  if (run != nullptr) runs[run->number] = encode_with_unknown(*run);
  return record_of(written, runs);
}

store::Result<std::string> Book::record(const dispatch::TakeoverChanges& taken, const Book& there) const {
  Reports reports;
  Runs runs;
  for (const dispatch::TakenOverReport& each : taken.reports) {
    const bool is_new = each.there != 0;
    const auto& from = is_new ? there.reports_ : reports_;
    const auto before = from.find(is_new ? each.there : each.report.number);
    StoredReport& kept = reports[each.report.number];
    if (before != from.end()) kept = before->second;
    if (!is_new) kept.history.clear();
    kept.record = to_bytes(each.report, more_of_report(kept.record));
    if (each.has_stepped) kept.history += step_of(each.report);
  }
  for (const Run& run : taken.runs) runs[run.number] = encode_with_unknown(run);
  return record_of(reports, runs);
}

std::string Book::encode_with_unknown(const Run& run) const {
  const auto known = runs_.find(run.number);
  return to_bytes(run, known == runs_.end() ? std::string_view() : more_of_run(known->second));
}

std::vector<Report> Book::reports() const {
  std::vector<Report> all;
  all.reserve(reports_.size());
  for (const auto& [number, kept] : reports_) all.push_back(*report_in(kept.record));
  return all;
}

std::vector<Run> Book::runs() const {
  std::vector<Run> all;
  all.reserve(runs_.size());
  for (const auto& [number, record] : runs_) all.push_back(*run_in(record));
  return all;
}

std::vector<Step> Book::history(std::int64_t number) const {
  const auto kept = reports_.find(number);
  return kept == reports_.end() ? std::vector<Step>() : *steps_in(kept->second.history);
}

store::Result<ReadResult> read(const store::Contents& contents) {
  ReadResult reading;
  bool is_cut = false;  // a log is truncated, so the content of its end is unknown
  for (const store::Item& item : contents.items) {
    if (const auto* const gap = std::get_if<store::Gap>(&item)) {
      reading.gap += icd::sentence(reading.gap.empty() ? "" : ", ", "records are missing in ", gap->file);
      reading.end_is_lost = true;
      is_cut = is_cut || (gap->first != 0 && !gap->last);
      continue;
    }
    const auto& record = std::get<store::Record>(item);
    if (record.kind != kSteps && (record.kind & store::kMustUnderstand) != 0) {
      return std::unexpected(
          Error{Error::Cause::Newer, icd::sentence("a later version wrote record ", record.sequence,
                                                   "; this one cannot use the ledger")});
    }
    if (!reading.book.apply(record.kind, record.body)) {
      reading.gap +=
          icd::sentence(reading.gap.empty() ? "" : ", ", "record ", record.sequence, " cannot be understood");
      reading.end_is_lost = true;
    } else if (record.kind == kSteps) {
      reading.end_is_lost = is_cut;  // the record has the highest number
    }
  }
  return reading;
}

// The rules for missing records (README.md, "Damage").
namespace {

using dispatch::ReportState;

constexpr std::int64_t kNumbersKeptFree = 1000;  // at least the most that can have been queued
constexpr const char* kDamaged = "the ledger was damaged: the Command Post's earlier counts are not certain";
constexpr const char* kHeld = "the ledger was damaged: it may have been sent since; the operator decides";

bool is_final(const Report& report) {
  using enum ReportState;
  return report.state == Answered || report.state == Settled || report.state == Withdrawn || report.is_lost();
}

/// "report 7 is", "reports 7 to 9 are"
std::string subject(std::int64_t from, std::int64_t to) {
  return from == to ? icd::sentence("report ", from, " is")
                    : icd::sentence("reports ", from, " to ", to, " are");
}

}  // namespace

std::string Book::salvage(double now, std::int64_t expected, bool end_is_lost) {
  const std::vector<Report> all = reports();
  for (Report report : all) {
    if (is_final(report)) continue;
    report.state = ReportState::InDoubt;
    report.sent = std::max(report.sent, last_heard());
    report.changed = now;
    report.note = kHeld;
    report.before.reset();
    report.counted = false;
    put(report);
  }
  // Without its record, the present run is the latest report's. Any other run may be resumed.
  std::int64_t last_run = runs_.empty() ? 1 : runs_.rbegin()->first;
  for (const Report& report : all) last_run = std::max(last_run, report.run);
  if (!runs_.contains(last_run)) {
    runs_[last_run] = to_bytes(Run{.number = last_run, .began = now, .why = "the ledger was damaged"});
  }
  for (auto& [number, kept] : runs_) {
    Run run = *run_in(kept);
    if (run.unreliable.empty()) run.unreliable = kDamaged;
    kept = to_bytes(run, more_of_run(kept));
  }
  highest_ = std::max(highest_, expected);
  std::string missing;
  std::int64_t next = 1;
  const auto miss = [&](std::int64_t from, std::int64_t to) {
    const std::string lost = subject(from, to) + " lost from the ledger";
    add_lost(to, lost + ": it may have been sent", now);
    missing += "; " + lost;
  };
  for (const Report& report : all) {  // a report that stands for others leaves no gap before it
    if (report.number > next && !report.is_lost()) miss(next, report.number - 1);
    next = report.number + 1;
  }
  if (next <= highest_) miss(next, highest_);
  if (end_is_lost) {
    next = highest_ + 1;
    const std::string lost = icd::sentence("reports may be missing from number ", next, " on");
    add_lost((next / kNumbersKeptFree + 1) * kNumbersKeptFree, lost + ": they may have been sent", now);
    missing += "; " + lost;
  }
  return icd::sentence(all.size(), all.size() == 1 ? " report was read" : " reports were read", missing);
}

/// The last time at which a run was heard. A report whose steps are missing may have been sent later, so it
/// may be of a run that began since.
double Book::last_heard() const {
  double last = 0;
  for (const auto& [number, run] : runs_) last = std::max(last, run_in(run)->heard);
  return last;
}

void Book::put(const Report& report) {
  StoredReport& kept = reports_[report.number];
  kept.record = to_bytes(report, more_of_report(kept.record));
  kept.history += step_of(report);
  highest_ = std::max(highest_, report.number);
}

/// Adds a report that stands for all lost ones up to this number.
void Book::add_lost(std::int64_t last, const std::string& note, double now) {
  const std::vector<Run> all = runs();
  const auto present = std::ranges::max_element(all, {}, &Run::place);
  put({.number = last,
       .report = {"?", {0, 0, 0}},
       .sender = std::string(Report::kLost),
       .received = now,
       .changed = now,
       .state = ReportState::InDoubt,
       .note = note,
       .run = present->number,
       .sent = last_heard()});
}

}  // namespace ledger
}  // namespace adit
