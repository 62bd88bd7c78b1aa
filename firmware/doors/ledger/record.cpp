#include "ledger/record.hpp"

#include <algorithm>
#include <concepts>

#include "codec/row.hpp"
#include "store/frame.hpp"

namespace adit {

namespace ledger {

/// The member at a path of pointers to members, and its name for people.
template <auto first, auto... rest>
struct Named {
  const char* name;

  auto& operator()(auto& of) const { return ((of.*first).*....*rest); }
};

}  // namespace ledger

// The members of reports and runs. Append new ones: earlier versions preserve them.

template <>
inline constexpr auto store::kMembers<dispatch::Report> = [] {
  using dispatch::Report, icd::ArtifactReport, ledger::Named;
  return std::tuple(Named<&Report::number>{"number"}, Named<&Report::report, &ArtifactReport::type>{"type"},
                    Named<&Report::report, &ArtifactReport::position, &icd::Point::x>{"x"},
                    Named<&Report::report, &ArtifactReport::position, &icd::Point::y>{"y"},
                    Named<&Report::report, &ArtifactReport::position, &icd::Point::z>{"z"},
                    Named<&Report::report, &ArtifactReport::robot>{"robot"}, Named<&Report::sender>{"sender"},
                    Named<&Report::received>{"received"}, Named<&Report::changed>{"changed"},
                    Named<&Report::state>{"state"}, Named<&Report::note>{"note"}, Named<&Report::run>{"run"},
                    Named<&Report::asked>{"asked"}, Named<&Report::same_as>{"same_as"},
                    Named<&Report::tries>{"tries"}, Named<&Report::sending>{"sending"},
                    Named<&Report::sent>{"sent"}, Named<&Report::before>{"before"},
                    Named<&Report::status>{"status"}, Named<&Report::content_type>{"content_type"},
                    Named<&Report::answer>{"answer"}, Named<&Report::reconciled>{"reconciled"},
                    Named<&Report::beside>{"beside"}, Named<&Report::counted>{"counted"},
                    Named<&Report::uncertain>{"uncertain"});
}();
template <>
inline constexpr auto store::kMembers<dispatch::Run> = [] {
  using dispatch::Run, ledger::Named;
  return std::tuple(Named<&Run::number>{"number"}, Named<&Run::id>{"id"}, Named<&Run::began>{"began"},
                    Named<&Run::why>{"why"}, Named<&Run::last>{"last"}, Named<&Run::heard>{"heard"},
                    Named<&Run::post>{"post"}, Named<&Run::unreliable>{"unreliable"},
                    Named<&Run::turn>{"turn"}, Named<&Run::may_be>{"may_be"},
                    Named<&Run::status_clock>{"status_clock"}, Named<&Run::answer_clock>{"answer_clock"},
                    Named<&Run::signs>{"signs"}, Named<&Run::name_trouble>{"name_trouble"});
}();
template <>
inline constexpr auto store::kMembers<dispatch::Clock> = std::tuple(
    ledger::Named<&dispatch::Clock::shows>{"shows"}, ledger::Named<&dispatch::Clock::runs>{"runs"});
template <>
inline constexpr auto store::kMembers<dispatch::Signs> = std::tuple(
    ledger::Named<&dispatch::Signs::count>{"count"}, ledger::Named<&dispatch::Signs::clock>{"clock"},
    ledger::Named<&dispatch::Signs::score>{"score"}, ledger::Named<&dispatch::Signs::name>{"name"});
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

class Put : public store::Writer {
 public:
  using store::Writer::operator();
  void operator()(ReportState state) { (*this)(dispatch::name_of(state)); }
  void operator()(const std::optional<icd::RobotName>& robot) { (*this)(icd::text_of(robot)); }
};

class Take : public store::Reader {
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

template <class Of>
std::optional<Of> take(std::string_view record) {
  Take take(record);
  Of what;
  store::walk(take, what);
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
std::string_view left_behind(std::string_view record) {
  Take take(record);
  Of what;
  store::walk(take, what);
  return take.left();
}

}  // namespace

std::string encoded(const Report& report, std::string_view more) {
  return store::bytes_of<Put>(report).append(more);
}

std::string encoded(const Run& run, std::string_view more) {
  return store::bytes_of<Put>(run).append(more);
}

std::optional<Report> report_in(std::string_view record) {
  return take<Report>(record);
}

std::optional<Run> run_in(std::string_view record) {
  return take<Run>(record);
}

std::string_view more_of_report(std::string_view record) {
  return left_behind<Report>(record);
}

std::string_view more_of_run(std::string_view record) {
  return left_behind<Run>(record);
}

codec::Value shown(const Report& report) {
  return show(report);
}

codec::Value shown(const Run& run) {
  return show(run);
}

std::string encoded(const Step& step) {
  return store::bytes_of(step);
}

std::string step_of(const Report& report) {
  return encoded(Step{report.changed, std::string(dispatch::name_of(report.state)), report.note});
}

std::optional<std::vector<Step>> steps_in(std::string_view record) {
  std::vector<Step> steps;
  store::Reader reader(record);
  while (reader.ok() && !reader.at_end()) steps.push_back(reader.read<Step>());
  return reader.ok() ? std::optional(std::move(steps)) : std::nullopt;
}

std::string encoded(const Steps& steps) {
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

}  // namespace ledger
}  // namespace adit
