#include "ledger/dump.hpp"

#include <utility>

#include "codec/json.hpp"
#include "codec/row.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "ledger/book.hpp"
#include "ledger/ledger.hpp"
#include "store/contents.hpp"
#include "store/directory.hpp"

namespace adit::ledger {
namespace {

using codec::json;
using codec::Value;

void add_unknown_bytes(Value& shown, std::string_view more) {
  if (!more.empty()) std::get<Value::Object>(shown.is).emplace_back("unknown_bytes", json(more.size()));
}

Value to_value(const Steps::Entry& entry) {
  Value report = ledger::to_value(*report_in(entry.report));
  Value::Array history;
  const auto steps = steps_in(entry.history);
  for (const Step& step : *steps)
    history.push_back(
        {Value::Object{{"at", json(step.at)}, {"state", json(step.state)}, {"note", json(step.note)}}});
  std::get<Value::Object>(report.is).emplace_back("history", Value{std::move(history)});
  add_unknown_bytes(report, more_of_report(entry.report));
  return report;
}

void put(Value::Object& line, const Steps& steps) {
  Value::Array reports, runs;
  for (const Steps::Entry& entry : steps.reports) reports.push_back(to_value(entry));
  for (const std::string_view record : steps.runs) {
    Value run = ledger::to_value(*run_in(record));
    add_unknown_bytes(run, more_of_run(record));
    runs.push_back(std::move(run));
  }
  line.emplace_back("highest", json(steps.highest));
  line.emplace_back("reports", Value{std::move(reports)});
  line.emplace_back("runs", Value{std::move(runs)});
}

Value::Object to_value(const store::Gap& gap) {
  return {{"gap",
           {Value::Object{{"first", json(gap.first)}, {"last", json(gap.last)}, {"file", json(gap.file)}}}}};
}

/// `damage`: gets a sentence if the record is invalid.
Value::Object to_value(const store::Record& record, std::vector<std::string>& damage) {
  Value::Object line{{"sequence", json(record.sequence)}, {"kind", json(record.kind)}};
  const bool is_known = record.kind == static_cast<std::uint8_t>(RecordKind::Steps);
  const auto steps = is_known ? steps_record_in(record.body) : std::nullopt;
  if (steps) {
    put(line, *steps);
  } else {
    line.emplace_back("bytes", json(record.body.size()));
    if (is_known) damage.push_back(icd::sentence("record ", record.sequence, " cannot be understood"));
  }
  return line;
}

}  // namespace

store::Result<std::vector<std::string>> dump(const std::string& directory,
                                             const std::function<void(const std::string&)>& print) {
  const auto there = ADIT_TRY(store::Directory::open(directory));
  auto contents = ADIT_TRY(store::Contents::read(there, Ledger::kKeeping));
  if (contents.is_new) return std::unexpected(store::Error{.what = directory + ": there is no ledger"});
  std::vector<std::string> damage = std::move(contents.notes);
  for (const store::Item& item : contents.items) {
    const auto* const gap = std::get_if<store::Gap>(&item);
    if (gap != nullptr) damage.push_back("records are missing in " + gap->file);
    print(codec::write_json(
              {gap != nullptr ? to_value(*gap) : to_value(std::get<store::Record>(item), damage)}) +
          '\n');
  }
  return damage;
}

}  // namespace adit::ledger
