#include "ledger/record.hpp"

#include <algorithm>
#include <concepts>

#include "codec/row.hpp"
#include "store/values.hpp"

namespace adit::ledger {
namespace {

using dispatch::Report;
using dispatch::ReportState;
using dispatch::Run;

class Put {
 public:
  void operator()(std::integral auto number) { out_.number(static_cast<std::uint64_t>(number)); }
  void operator()(double real) { out_.real(real); }
  void operator()(std::string_view text) { out_.text(text); }
  void operator()(const std::string& text) { out_.text(text); }
  void operator()(ReportState state) { out_.text(dispatch::name_of(state)); }
  void operator()(const std::optional<icd::RobotName>& robot) { out_.text(robot ? robot->text() : ""); }
  void operator()(const std::optional<dispatch::Clock>& clock) {
    (*this)(clock.has_value());
    const dispatch::Clock put = clock.value_or(dispatch::Clock());
    (*this)(put.shows);
    (*this)(put.runs);
  }
  void operator()(const std::optional<icd::RunStatus>& status) {
    (*this)(status.has_value());
    const icd::RunStatus put = status.value_or(icd::RunStatus());
    (*this)(put.score);
    (*this)(put.run_clock);
    (*this)(put.remaining_reports);
    (*this)(put.current_team);
  }
  void operator()(const char* /*name*/, const auto& value) { (*this)(value); }
  std::string finish(std::string_view more) { return out_.finish().append(more); }

 private:
  store::Writer out_;
};

class Take {
 public:
  explicit Take(std::string_view said) : in_(said) {}

  template <std::integral Whole>
  void operator()(Whole& number) {
    number = static_cast<Whole>(in_.number());
  }
  void operator()(double& real) { real = in_.real(); }
  void operator()(std::string& text) { text = in_.text(); }
  void operator()(ReportState& state) {
    const std::string_view word = in_.text();
    const auto* const known = std::ranges::find(dispatch::kStateWords, word);
    if (known == std::end(dispatch::kStateWords)) unknown_ = word;
    state = unknown_.empty() ? static_cast<ReportState>(known - std::begin(dispatch::kStateWords))
                             : ReportState::InDoubt;
  }
  void operator()(std::optional<icd::RobotName>& robot) { robot = icd::RobotName::parse(in_.text()); }
  void operator()(std::optional<dispatch::Clock>& clock) {
    const bool is_there = in_.number() != 0;
    dispatch::Clock taken;
    (*this)(taken.shows);
    (*this)(taken.runs);
    if (is_there) clock = taken;
  }
  void operator()(std::optional<icd::RunStatus>& status) {
    const bool is_there = in_.number() != 0;
    icd::RunStatus taken;
    (*this)(taken.score);
    (*this)(taken.run_clock);
    (*this)(taken.remaining_reports);
    (*this)(taken.current_team);
    if (is_there) status = std::move(taken);
  }

  void operator()(const char* /*name*/, auto& value) { (*this)(value); }

  bool ok() const { return in_.ok(); }
  std::string_view left() const { return in_.left(); }
  /// The word of a state that this version does not know, or "".
  std::string_view unknown_state() const { return unknown_; }

 private:
  store::Reader in_;
  std::string_view unknown_;
};

class Show {
 public:
  void operator()(const char* name, const auto& value) { members_.emplace_back(name, codec::json(value)); }
  void operator()(const char* name, ReportState state) {
    (*this)(name, std::string(dispatch::name_of(state)));
  }
  void operator()(const char* name, const std::optional<icd::RobotName>& robot) {
    (*this)(name, robot ? robot->text() : "");
  }
  void operator()(const char* name, const std::optional<dispatch::Clock>& clock) {
    Show shown;
    if (clock) shown("shows", clock->shows), shown("runs", clock->runs);
    (*this)(name, clock ? shown.finish() : codec::Value());
  }
  codec::Value finish() { return {std::move(members_)}; }

 private:
  codec::Value::Object members_;
};

// The members in their order in a record, with the names that people read. A new one comes last: an earlier
// version keeps it as it is.

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
}

template <class Of>
std::string put(const Of& what, std::string_view more) {
  Put put;
  members(put, what);
  return put.finish(more);
}

template <class Of>
std::optional<Of> take(std::string_view said) {
  Take take(said);
  Of what;
  members(take, what);
  if (!take.ok() || what.number < 1) return std::nullopt;
  if constexpr (std::same_as<Of, Report>) {
    if (!take.unknown_state().empty()) {  // without `before` nobody but the operator judges it
      what.note =
          "its state '" + std::string(take.unknown_state()) + "' is unknown to this version; " + what.note;
      what.before.reset();
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
std::string_view left_behind(std::string_view said) {
  Take take(said);
  Of what;
  members(take, what);
  return take.left();
}

}  // namespace

std::string said(const Report& report, std::string_view more) {
  return put(report, more);
}

std::string said(const Run& run, std::string_view more) {
  return put(run, more);
}

std::optional<Report> report_in(std::string_view said) {
  return take<Report>(said);
}

std::optional<Run> run_in(std::string_view said) {
  return take<Run>(said);
}

std::string_view more_of_report(std::string_view said) {
  return left_behind<Report>(said);
}

std::string_view more_of_run(std::string_view said) {
  return left_behind<Run>(said);
}

codec::Value shown(const Report& report) {
  return show(report);
}

codec::Value shown(const Run& run) {
  return show(run);
}

std::string said(const Step& step) {
  return store::Writer().real(step.at).text(step.state).text(step.note).finish();
}

std::string step_of(const Report& report) {
  return said(Step{report.changed, std::string(dispatch::name_of(report.state)), report.note});
}

std::optional<std::vector<Step>> steps_in(std::string_view said) {
  std::vector<Step> steps;
  store::Reader reader(said);
  while (!reader.at_end()) {
    const double at = reader.real();
    const std::string_view state = reader.text(), note = reader.text();
    if (!reader.ok()) return std::nullopt;
    steps.push_back({at, std::string(state), std::string(note)});
  }
  return steps;
}

std::string said(const Steps& steps) {
  store::Writer out;
  out.number(static_cast<std::uint64_t>(steps.highest)).number(steps.reports.size());
  for (const Steps::Entry& entry : steps.reports) out.text(entry.report).text(entry.history);
  out.number(steps.runs.size());
  for (const std::string_view run : steps.runs) out.text(run);
  return out.finish();
}

std::optional<Steps> steps_record_in(std::string_view said) {
  store::Reader reader(said);
  Steps steps{.highest = static_cast<std::int64_t>(reader.number()), .reports = {}, .runs = {}};
  for (std::uint64_t left = reader.number(); left > 0 && reader.ok(); --left) {
    const std::string_view report = reader.text(), history = reader.text();
    if (!report_in(report) || !steps_in(history)) return std::nullopt;
    steps.reports.push_back({report, history});
  }
  for (std::uint64_t left = reader.number(); left > 0 && reader.ok(); --left) {
    steps.runs.push_back(reader.text());
    if (!run_in(steps.runs.back())) return std::nullopt;
  }
  if (!reader.ok() || !reader.at_end()) return std::nullopt;
  return steps;
}

}  // namespace adit::ledger
