#include "ledger/ledger.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "store/directory.hpp"
#include "store/frame.hpp"
#include "store/log.hpp"

namespace adit::ledger {
namespace {

Result<void> write(store::Snapshot& snapshot, const Book& book, const std::atomic<bool>& enough) {
  for (const auto& [kind, body] : book.records()) {
    if (enough) return std::unexpected(Error{.what = "aditd is stopping"});
    if (auto added = snapshot.add(kind, body); !added) return added;
  }
  return snapshot.finish();
}

}  // namespace

LedgerFacts latest_of(const LedgerFacts& one, const LedgerFacts& other) {
  return {.reports = std::max(one.reports, other.reports),
          .log = std::max(one.log, other.log),
          .last = std::max(one.last, other.last)};
}

KnownFile::KnownFile(const std::string& path) {
  if (path.empty()) return;
  constexpr std::size_t kMost = 4096;
  file_ = loop::FileDescriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600));
  std::string bytes(kMost, '\0');
  const auto size = file_ ? ::pread(file_.get(), bytes.data(), bytes.size(), 0) : -1;
  if (size < 0) trouble_ = icd::sentence(path, ": ", std::generic_category().message(errno));
  bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  const auto known = store::value_in<LedgerFacts>(bytes);
  if (!known && size > 0) trouble_ = path + " is damaged";
  known_ = known.value_or(LedgerFacts());
}

void KnownFile::write(const LedgerFacts& known) {
  if (!file_ || known == known_) return;
  known_ = known;
  if (store::write_all(file_.get(), store::file_of(known, store::kInMemory), 0) != 0)
    (void)::ftruncate(file_.get(), 0);
}

Result<Ledger> Ledger::open(const std::string& state, const LedgerFacts& stored, const std::string& memory) {
  Ledger ledger;
  ledger.directory_ =
      std::make_shared<store::Directory>(ADIT_TRY(store::Directory::lock(state + '/' + kDirectory)));
  auto& contents = ledger.contents_ = ADIT_TRY(store::Contents::read(*ledger.directory_, kKeeping));
  auto reading = ADIT_TRY(read(contents));
  Book& book = ledger.book_ = std::move(reading.book);
  const KnownFile& file = ledger.file_ = KnownFile(memory);
  const LedgerFacts known = ledger.known_ = latest_of(stored, file.content());
  if ((known.log != 0 && !contents.has(known.log)) || book.highest() < known.reports ||
      contents.last < known.last) {
    reading.gap += icd::sentence(reading.gap.empty() ? "" : ", ", "its last records are not there");
    const bool has_all_reports = file.content().last > 0 && file.content().last == known.last;
    reading.end_is_lost = reading.end_is_lost || !has_all_reports;
  }
  // File names are never reused, even of removed logs.
  contents.number = std::max(contents.number, known.log);
  contents.last = std::max(contents.last, known.last);  // nor are sequence numbers
  std::string& damage = ledger.damage_;
  ledger.is_damaged_ = !reading.gap.empty();
  if (ledger.is_damaged_) {
    const std::string found = book.salvage(loop::system_now(), known.reports, reading.end_is_lost);
    damage = icd::sentence("The ledger was damaged (", reading.gap, "). Its files are kept in ", state, "/",
                           kDirectory, "/damaged-*; ", found, ".");
  } else if (!contents.notes.empty()) {
    damage = "The ledger's files were damaged and were repaired: ";
    for (const std::string& note : contents.notes)
      damage += (note == contents.notes.front() ? "" : "; ") + note;
    damage += ". No report is missing.";
  }
  (void)ledger.make_ready();  // refusal() has the reason
  return ledger;
}

Ledger Ledger::make_closed(std::string why, const LedgerFacts& known, const std::string& memory) {
  Ledger ledger;
  ledger.refusal_ = std::move(why);
  ledger.known_ = latest_of(known, KnownFile(memory).content());
  return ledger;
}

bool Ledger::can_be_read(const std::string& state) {
  const auto directory = store::Directory::lock(state + '/' + kDirectory);
  return directory && store::Contents::read(*directory, kKeeping);
}

Result<std::string> Ledger::set_aside(const std::string& state) {
  const auto folder = ADIT_TRY(store::Directory::open(state));
  return folder.rename_aside(kDirectory);
}

Result<void> Ledger::write(std::span<const dispatch::Report> steps, const dispatch::Run* run,
                           dispatch::Flush flush) {
  if (steps.empty() && run == nullptr) return {};
  const auto record = ADIT_TRY(book_.record(steps, run));
  const bool has_new =
      std::ranges::any_of(steps, [this](const dispatch::Report& step) { return !book_.knows(step.number); });
  return append(record, flush, has_new);
}

Result<void> Ledger::append(const std::string& record, dispatch::Flush flush, bool has_new) {
  if (auto ready = has_new ? make_ready(record.size()) : begin(); !ready) return ready;
  const auto durability = flush == dispatch::Flush::Now ? store::Durability::Now : store::Durability::Soon;
  constexpr auto kKind = static_cast<std::uint8_t>(RecordKind::Steps);
  if (auto appended = log_->append(kKind, record, durability); !appended) return appended;
  (void)book_.apply(kKind, record);
  file_.write(known_facts());
  return {};
}

Result<void> Ledger::flush() {
  auto flushed = log_ ? log_->flush() : Result<void>();
  file_.write(known_facts());
  return flushed;
}

LedgerFacts Ledger::known_facts() const {
  return {.reports = std::max(known_.reports, book_.highest()),
          .log = has_begun_ ? log_->number() : known_.log,
          .last = has_begun_ ? log_->durable() : known_.last};
}

Result<void> Ledger::make_ready(std::size_t record) {
  auto ready = begin();
  if (ready && log_->room() < log_->bytes_of(record) + kForKnown) ready = log_->turn();
  refusal_ = ready ? "" : ready.error().what;
  return ready;
}

/// Continues after the records that were read. A damaged ledger begins with a snapshot of the rest.
Result<void> Ledger::begin() {
  if (has_begun_) return {};
  if (!directory_) return std::unexpected(Error{.what = refusal_});
  auto begun = begin_log();
  refusal_ = begun ? "" : begun.error().what;
  has_begun_ = begun.has_value();
  file_.write(known_facts());
  return begun;
}

std::function<Result<void>()> Ledger::upkeep() {
  if (!has_begun_ || is_under_way_) return nullptr;
  if (log_->number() == snapshot_) {
    if (spare_ == log_->number()) return nullptr;
    is_under_way_ = true;
    next_spare_ = log_->number();
    return [directory = directory_, enough = enough_.flag] {
      return store::make_spare(*directory, kKeeping, *enough);
    };
  }
  auto begun = store::Snapshot::begin(*directory_, kKeeping, *log_);
  is_under_way_ = true;
  if (!begun) return [error = begun.error()] { return Result<void>(std::unexpected(error)); };
  next_snapshot_ = log_->number();
  return [directory = directory_, enough = enough_.flag, book = book_,
          snapshot = std::make_shared<store::Snapshot>(std::move(*begun))] {
    return ledger::write(*snapshot, book, *enough);
  };
}

void Ledger::on_upkeep_done(const Result<void>& done) {
  is_under_way_ = false;
  if (!done) return;
  snapshot_ = next_snapshot_;
  spare_ = next_spare_;
}

/// After a failure, the next try resumes at the failed step.
Result<void> Ledger::begin_log() {
  if (!log_) {
    store::Log log(*directory_, kKeeping);
    if (auto started = log.start(contents_); !started) return started;
    log_ = std::make_unique<store::Log>(std::move(log));
    // So a snapshot that a kill interrupted is due again.
    if (!contents_.logs.empty()) snapshot_ = next_snapshot_ = contents_.logs.front();
    contents_ = {};
  }
  if (is_damaged_) return begin_after_damage();
  if (log_->number() != 0) return {};
  auto turned = log_->turn();
  snapshot_ = next_snapshot_ = log_->number();
  return turned;
}

Result<void> Ledger::begin_after_damage() {
  if (!is_aside_) {
    if (auto aside = directory_->put_aside(); !aside) return aside;
    is_aside_ = true;
  }
  if (!has_turned_) {
    if (auto turned = log_->turn(); !turned) return turned;
    has_turned_ = true;
  }
  auto snapshot = ADIT_TRY(store::Snapshot::begin(*directory_, kKeeping, *log_));
  if (auto written = ledger::write(snapshot, book_, *enough_.flag); !written) return written;
  snapshot_ = next_snapshot_ = log_->number();
  is_damaged_ = false;
  return {};
}

Result<std::string> Ledger::copy() const {
  if (is_closed()) return std::unexpected(Error{.what = "the ledger cannot be read: " + refusal_});
  return book_.copy();
}

Result<void> Ledger::take_over(const std::string& copy, const dispatch::Handover& handover) {
  Book there;
  if (!there.apply(static_cast<std::uint8_t>(RecordKind::Steps), copy))
    return std::unexpected(Error{.what = "it is no copy of a ledger"});
  const Book& here = book_;
  const dispatch::TakeoverChanges taken =
      dispatch::take_over({here.reports(), here.runs()}, {there.reports(), there.runs()}, handover);
  const auto record = ADIT_TRY(here.record(taken, there));
  return append(record, dispatch::Flush::Now, true);
}

}  // namespace adit::ledger
