#include "ledger/record.hpp"

#include <algorithm>
#include <concepts>

#include "codec/row.hpp"
#include "store/frame.hpp"

namespace adit {

template <>
inline constexpr auto store::kMembers<dispatch::Clock> =
    std::tuple(&dispatch::Clock::shows, &dispatch::Clock::runs);
template <>
inline constexpr auto store::kMembers<dispatch::Signs> = std::tuple(
    &dispatch::Signs::count, &dispatch::Signs::clock, &dispatch::Signs::score, &dispatch::Signs::name);
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
  void operator()(const char* /*name*/, const auto& value) { store::walk(*this, value); }
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
  void operator()(const char* /*name*/, auto& value) { store::walk(*this, value); }

  /// The word of a state unknown to this version, or "".
  std::string_view unknown_state() const { return unknown_; }

 private:
  std::string_view unknown_;
};

class Show {
 public:
  void operator()(const char* name, const auto& value) { members_.emplace_back(name, codec::json(value)); }
  void operator()(const char* name, ReportState state) {
    (*this)(name, std::string(dispatch::name_of(state)));
  }
  void operator()(const char* name, const std::optional<icd::RobotName>& robot) {
    (*this)(name, icd::text_of(robot));
  }
  void operator()(const char* name, const std::optional<dispatch::Clock>& clock) {
    Show shown;
    if (clock) shown("shows", clock->shows), shown("runs", clock->runs);
    (*this)(name, clock ? shown.finish() : codec::Value());
  }
  void operator()(const char* name, const dispatch::Signs& signs) {
    Show shown;
    shown("count", signs.count), shown("clock", signs.clock);
    shown("score", signs.score), shown("name", signs.name);
    (*this)(name, shown.finish());
  }
  codec::Value finish() { return {std::move(members_)}; }

 private:
  codec::Value::Object members_;
};

// The members in record order, with names for people. Append new ones: earlier versions preserve them.

void members(auto& each, auto& report)
  requires std::same_as<std::remove_const_t<std::remove_reference_t<decltype(report)>>, Report>
{
  each("number", report.number);
  each("type", report.report.type);
  each("x", report.report.position.x);
  each("y", report.report.position.y);
  each("z", report.report.position.z);
  each("robot", report.report.robot);
  each("sender", report.sender);
  each("received", report.received);
  each("changed", report.changed);
  each("state", report.state);
  each("note", report.note);
  each("run", report.run);
  each("asked", report.asked);
  each("same_as", report.same_as);
  each("tries", report.tries);
  each("sending", report.sending);
  each("sent", report.sent);
  each("before", report.before);
  each("status", report.status);
  each("content_type", report.content_type);
  each("answer", report.answer);
  each("reconciled", report.reconciled);
  each("beside", report.beside);
  each("counted", report.counted);
  each("uncertain", report.uncertain);
}

void members(auto& each, auto& run)
  requires std::same_as<std::remove_const_t<std::remove_reference_t<decltype(run)>>, Run>
{
  each("number", run.number);
  each("id", run.id);
  each("began", run.began);
  each("why", run.why);
  each("last", run.last);
  each("heard", run.heard);
  each("post", run.post);
  each("unreliable", run.unreliable);
  each("turn", run.turn);
  each("may_be", run.may_be);
  each("status_clock", run.status_clock);
  each("answer_clock", run.answer_clock);
  each("signs", run.signs);
  each("name_trouble", run.name_trouble);
}

template <class Of>
std::string put(const Of& what, std::string_view more) {
  Put put;
  members(put, what);
  return put.finish().append(more);
}

template <class Of>
std::optional<Of> take(std::string_view record) {
  Take take(record);
  Of what;
  members(take, what);
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
codec::Value show(const Of& what) {
  Show show;
  members(show, what);
  return show.finish();
}

template <class Of>
std::string_view left_behind(std::string_view record) {
  Take take(record);
  Of what;
  members(take, what);
  return take.left();
}

}  // namespace

std::string encoded(const Report& report, std::string_view more) {
  return put(report, more);
}

std::string encoded(const Run& run, std::string_view more) {
  return put(run, more);
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
