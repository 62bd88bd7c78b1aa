#include "gateway/report_book.hpp"

#include <algorithm>
#include <utility>

#include "codec/read.hpp"
#include "host/log.hpp"

namespace adit::gateway {
namespace {

using dispatch::ReportEvent;
using dispatch::ReportState;

std::string words(ReportState state) {
  return std::string(dispatch::name_of(state));
}

/// A state that this version does not know is one that only the operator can judge.
ReportState state_of(const ledger::Entry& entry) {
  return dispatch::state_named(entry.state).value_or(ReportState::InDoubt);
}

page::ReportRow row_of(const ledger::Entry& entry) {
  page::ReportRow row{.number = entry.number,
                      .type = entry.report.type,
                      .position = entry.report.position,
                      .sender = entry.sender,
                      .received = entry.received,
                      .changed = entry.changed,
                      .state = entry.state,
                      .status = entry.status,
                      .report_status = "",
                      .score_change = std::nullopt,
                      .note = entry.note};
  if (const auto reply = codec::read_report_reply(entry.answer)) {
    row.report_status = reply->report_status;
    row.score_change = reply->score_change;
  }
  return row;
}

}  // namespace

std::expected<std::vector<std::int64_t>, std::string> ReportBook::open() {
  auto all = ledger_.all();
  if (!all) return std::unexpected(all.error().what);
  std::vector<std::int64_t> waiting;
  for (ledger::Entry& entry : *all) {
    const std::int64_t number = entry.number;
    const ReportState before = state_of(entry);
    entries_.emplace(number, std::move(entry));
    const bool changes = dispatch::next(before, ReportEvent::Restarted) != before;
    if (changes && !move(number, ReportEvent::Restarted, "the gateway stopped while it was being sent")) {
      return std::unexpected(trouble_);
    }
    if (before == ReportState::Waiting) waiting.push_back(number);
  }
  return waiting;
}

std::expected<std::int64_t, std::string> ReportBook::add(const icd::ArtifactReport& report,
                                                         const std::string& sender) {
  const double now = loop_.stamp_now();
  const auto number = ledger_.add(report, sender, words(ReportState::Waiting), now);
  if (!number) {
    trouble_ = number.error().what;
    host::log(host::Level::Error, "a report could not be written down and was not taken",
              {{"why", trouble_}});
    return std::unexpected(trouble_);
  }
  trouble_.clear();
  ledger::Entry& entry = entries_[*number];
  entry.number = *number;
  entry.report = report;
  entry.sender = sender;
  entry.received = entry.changed = now;
  entry.state = words(ReportState::Waiting);
  host::log(host::Level::Notice, "report received",
            {{"report", std::to_string(*number)}, {"type", report.type}, {"sender", sender}});
  return *number;
}

bool ReportBook::move(std::int64_t number, ReportEvent event, const std::string& note) {
  ledger::Entry& entry = entries_.at(number);
  const auto to = dispatch::next(state_of(entry), event);
  if (!to) {
    host::log(host::Level::Error, "a report's life took a step that does not exist",
              {{"report", std::to_string(number)}, {"state", entry.state}});
    return false;
  }
  ledger::Entry after = entry;
  after.state = words(*to);
  after.note = note;
  after.changed = loop_.stamp_now();
  const auto written = ledger_.change(after, after.changed);
  if (!written) {
    trouble_ = written.error().what;
    host::log(host::Level::Error, "a report's step could not be written down",
              {{"report", std::to_string(number)}, {"why", trouble_}});
    if (event != ReportEvent::Chosen) entry = std::move(after);  // it has happened all the same
    return false;
  }
  trouble_.clear();
  entry = std::move(after);
  host::log(*to == ReportState::InDoubt ? host::Level::Warning : host::Level::Notice, "report " + words(*to),
            {{"report", std::to_string(number)},
             {"status", entry.status != 0 ? std::to_string(entry.status) : ""},
             {"why", note}});
  return true;
}

void ReportBook::set_answer(std::int64_t number, const uplink::Answered& answered) {
  ledger::Entry& entry = entries_.at(number);
  entry.status = answered.status;
  entry.content_type = answered.content_type;
  entry.answer = answered.body;
}

std::vector<page::ReportRow> ReportBook::rows() const {
  std::vector<page::ReportRow> rows;
  rows.reserve(std::min(entries_.size(), kMostRows));
  for (auto entry = entries_.rbegin(); entry != entries_.rend() && rows.size() < kMostRows; ++entry) {
    rows.push_back(row_of(entry->second));
  }
  return rows;
}

std::size_t ReportBook::in_doubt() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      entries_, [](const auto& item) { return state_of(item.second) == ReportState::InDoubt; }));
}

}  // namespace adit::gateway
