#include "ledger/ledger.hpp"

#include <utility>

#include "ledger/database.hpp"
#include "ledger/opening.hpp"

namespace adit::ledger {
namespace {

constexpr const char* kAdd =
    "INSERT INTO report(type, x, y, z, sender, received, changed, state, status, content_type, answer, note) "
    "VALUES(?, ?, ?, ?, ?, ?, ?, ?, 0, '', x'', '')";
constexpr const char* kChange =
    "UPDATE report SET changed = ?, state = ?, status = ?, content_type = ?, answer = ?, note = ? "
    "WHERE number = ?";
constexpr const char* kStep = "INSERT INTO step(report, at, state, note) VALUES(?, ?, ?, ?)";
constexpr const char* kAll =
    "SELECT number, type, x, y, z, sender, received, changed, state, status, content_type, answer, note "
    "FROM report ORDER BY number";
constexpr const char* kFind =
    "SELECT number, type, x, y, z, sender, received, changed, state, status, content_type, answer, note "
    "FROM report WHERE number = ?";

/// The row that kAll and kFind select.
Entry entry_of(const Run& row) {
  Entry entry;
  entry.number = row.number(0);
  entry.report = {row.bytes(1), {row.real(2), row.real(3), row.real(4)}};
  entry.sender = row.bytes(5);
  entry.received = row.real(6);
  entry.changed = row.real(7);
  entry.state = row.bytes(8);
  entry.status = static_cast<int>(row.number(9));
  entry.content_type = row.bytes(10);
  entry.answer = row.bytes(11);
  entry.note = row.bytes(12);
  return entry;
}

}  // namespace

class Ledger::Impl {
 public:
  static Result<std::unique_ptr<Impl>> make(Opened opened) {
    auto impl = std::make_unique<Impl>(std::move(opened));
    const std::pair<Statement*, const char*> statements[] = {{&impl->add_, kAdd},
                                                             {&impl->change_, kChange},
                                                             {&impl->step_, kStep},
                                                             {&impl->all_, kAll},
                                                             {&impl->find_, kFind}};
    for (const auto& [statement, sql] : statements) {
      auto prepared = Statement::prepare(impl->database_, sql);
      if (!prepared) return std::unexpected(prepared.error());
      *statement = std::move(*prepared);
    }
    return impl;
  }

  explicit Impl(Opened opened) : database_(std::move(opened.database)), damage_(std::move(opened.damage)) {}

  Result<std::int64_t> add(const icd::ArtifactReport& report, const std::string& sender,
                           const std::string& state, double now) {
    Transaction transaction(database_);
    if (auto begun = transaction.begin(); !begun) return std::unexpected(begun.error());
    Run run(add_);
    run.bind(report.type).bind(report.position.x).bind(report.position.y).bind(report.position.z);
    run.bind(sender).bind(now).bind(now).bind(state);
    if (run.step() != SQLITE_DONE) return std::unexpected(database_.error("recording a report"));
    const std::int64_t number = sqlite3_last_insert_rowid(database_.get());
    if (auto stepped = step(number, now, state, ""); !stepped) return std::unexpected(stepped.error());
    if (auto committed = transaction.commit(); !committed) return std::unexpected(committed.error());
    return number;
  }

  Result<void> change(const Entry& entry, double now) {
    Transaction transaction(database_);
    if (auto begun = transaction.begin(); !begun) return std::unexpected(begun.error());
    const std::string doing = "recording a step of report " + std::to_string(entry.number);
    Run run(change_);
    run.bind(now).bind(entry.state).bind(std::int64_t{entry.status}).bind(entry.content_type);
    run.bind_blob(entry.answer).bind(entry.note).bind(entry.number);
    if (run.step() != SQLITE_DONE) return std::unexpected(database_.error(doing));
    if (sqlite3_changes(database_.get()) != 1)
      return std::unexpected(Error{doing + ": there is no such report", false});
    if (auto stepped = step(entry.number, now, entry.state, entry.note); !stepped)
      return std::unexpected(stepped.error());
    if (auto committed = transaction.commit(); !committed) return std::unexpected(committed.error());
    return {};
  }

  Result<std::vector<Entry>> all() {
    std::vector<Entry> entries;
    Run run(all_);
    int result = SQLITE_OK;
    while ((result = run.step()) == SQLITE_ROW) entries.push_back(entry_of(run));
    if (result != SQLITE_DONE) return std::unexpected(database_.error("reading the reports"));
    return entries;
  }

  Result<std::optional<Entry>> find(std::int64_t number) {
    Run run(find_);
    const int result = run.bind(number).step();
    if (result == SQLITE_ROW) return entry_of(run);
    if (result == SQLITE_DONE) return std::nullopt;
    return std::unexpected(database_.error("reading report " + std::to_string(number)));
  }

  const std::string& damage() const { return damage_; }

 private:
  Attempt<void> step(std::int64_t number, double at, const std::string& state, const std::string& note) {
    Run run(step_);
    run.bind(number).bind(at).bind(state).bind(note);
    if (run.step() == SQLITE_DONE) return {};
    return std::unexpected(database_.error("recording a step of report " + std::to_string(number)));
  }

  Database database_;  // before the statements, which it outlives
  std::string damage_;
  Statement add_, change_, step_, all_, find_;
};

Ledger::Ledger(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Ledger::Ledger(Ledger&&) noexcept = default;
Ledger& Ledger::operator=(Ledger&&) noexcept = default;
Ledger::~Ledger() = default;

Result<Ledger> Ledger::open(const std::string& folder) {
  auto opened = open_database(folder);
  if (!opened) return std::unexpected(std::move(opened.error()));
  auto impl = Impl::make(std::move(*opened));
  if (!impl) return std::unexpected(std::move(impl.error()));
  return Ledger(std::move(*impl));
}

Result<std::int64_t> Ledger::add(const icd::ArtifactReport& report, const std::string& sender,
                                 const std::string& state, double now) {
  return impl_->add(report, sender, state, now);
}
Result<void> Ledger::change(const Entry& entry, double now) {
  return impl_->change(entry, now);
}
Result<std::vector<Entry>> Ledger::all() const {
  return impl_->all();
}
Result<std::optional<Entry>> Ledger::find(std::int64_t number) const {
  return impl_->find(number);
}
const std::string& Ledger::damage() const {
  return impl_->damage();
}

}  // namespace adit::ledger
