#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "dispatch/merged_reports.hpp"
#include "dispatch/output.hpp"
#include "dispatch/report.hpp"
#include "dispatch/runs.hpp"
#include "ledger/book.hpp"
#include "loop/file_descriptor.hpp"
#include "store/contents.hpp"
#include "store/directory.hpp"
#include "store/frame.hpp"
#include "store/log.hpp"

namespace adit::ledger {

using store::Error;
using store::Result;

/// Facts about a ledger that are stored elsewhere. A ledger with less is damaged.
struct LedgerFacts {
  std::int64_t reports = 0;  // count of numbers given out
  std::uint64_t log = 0;     // number of its last log; 0: unknown
  std::uint64_t last = 0;    // sequence number of its last record on the disk; 0: unknown

  friend bool operator==(const LedgerFacts&, const LedgerFacts&) = default;
};
LedgerFacts latest_of(const LedgerFacts& one, const LedgerFacts& other);

/// What a process of this boot knew last, as the only value of a file in memory.
class KnownFile {
 public:
  KnownFile() = default;
  /// `path` "": no file.
  explicit KnownFile(const std::string& path);
  /// The last values in the file; 0: unknown.
  const LedgerFacts& content() const { return known_; }
  /// Why the file could not be opened or read, or "".
  const std::string& trouble() const { return trouble_; }
  /// After a failed write the file is empty, so that no older values are believed.
  void write(const LedgerFacts& known);

 private:
  loop::FileDescriptor file_;
  LedgerFacts known_;
  std::string trouble_;
};

/// Tells running upkeep to stop, at the latest when it is destroyed.
class StopSource {
 public:
  StopSource() = default;
  StopSource(StopSource&& other) noexcept : flag(std::move(other.flag)) {}
  StopSource& operator=(StopSource&& other) noexcept {
    flag.swap(other.flag);
    return *this;
  }
  ~StopSource() { set(); }
  void set() {
    if (flag) *flag = true;
  }

  std::shared_ptr<std::atomic<bool>> flag = std::make_shared<std::atomic<bool>>(false);
};

/// All artifact reports with all their steps, and all runs, in a log on disk (store/README.md; records:
/// README.md). A successful write is on disk; a failed one has no effect.
class Ledger {
 public:
  static constexpr store::LogOptions kKeeping{store::kOnDisk, 4u << 20, true};
  static constexpr const char* kDirectory = "ledger";       // below the state directory
  static constexpr const char* kMemory = "ledger-on-disk";  // below the runtime directory
  /// Bytes that a new report must leave in the file for steps of the known reports.
  static constexpr std::size_t kForKnown = 64u << 10;  // bytes

  /// Opens the ledger of a state directory, or creates one. If records are missing, also because a ledger in
  /// `known` is gone, each report that may have been sent becomes in doubt, and damage() says so. If the
  /// directory cannot be written, reports can be read, refusal() has the reason, and a later write may
  /// succeed. Error: unreadable, locked by another process, or from a later version; no file is changed.
  /// `memory`: a file in memory that always has known_facts(), so that an older copy of the ledger is damage;
  /// "": none.
  static Result<Ledger> open(const std::string& state, const LedgerFacts& known = {},
                             const std::string& memory = "");
  /// A ledger that cannot be read, for `why`. It has no reports and rejects new ones. known_facts() has the
  /// latest of `known` and of the file `memory`, as in open().
  static Ledger make_closed(std::string why, const LedgerFacts& known, const std::string& memory = "");
  /// Whether open() would succeed. Blocks on the disk; any thread.
  static bool can_be_read(const std::string& state);
  /// Renames an unreadable ledger, so that the next open() creates a new one. Returns the new name.
  static Result<std::string> set_aside(const std::string& state);

  /// Writes all steps in order as one record, each with the report's state after it. With Soon they survive
  /// this process, and a power cut after the next write with Now, or flush(). A report's type, position and
  /// time of receipt never change: a step with others under a used number is an error. `run`, if not null, is
  /// written with them.
  Result<void> write(std::span<const dispatch::Report> steps, const dispatch::Run* run = nullptr,
                     dispatch::Flush flush = dispatch::Flush::Now);
  Result<void> write(const dispatch::Run& run) { return write({}, &run); }
  /// Syncs writes with Soon.
  Result<void> flush();
  /// Prepares a write. Error: a new report could not be written now.
  Result<void> make_ready() { return make_ready(0); }

  std::vector<dispatch::Report> reports() const { return book_.reports(); }  // oldest first
  std::vector<dispatch::Run> runs() const { return book_.runs(); }           // oldest first
  /// All steps of a report, oldest first.
  std::vector<Step> history(std::int64_t report) const { return book_.history(report); }

  /// Reports, steps and runs as bytes for take_over(). Error if the ledger is closed.
  Result<std::string> copy() const;
  /// Whether the bytes are from copy().
  static bool is_copy(const std::string& copy) { return steps_record_in(copy).has_value(); }
  /// Takes over another box's reports and runs by dispatch::take_over(), with all histories, as one record.
  Result<void> take_over(const std::string& copy, const dispatch::Handover& handover);

  /// A sentence about damage found by open(), or "".
  const std::string& damage() const { return damage_; }
  /// Why open() could not read the file in memory, so that an older copy may be believed; or "".
  const std::string& warning() const { return file_.trouble(); }
  /// Why the last try to accept a new report failed, or "".
  const std::string& refusal() const { return refusal_; }
  bool is_closed() const { return directory_ == nullptr; }
  /// Facts to store elsewhere, never less than open() was given.
  LedgerFacts known_facts() const;

  /// Due work for another thread: a snapshot or a spare file. Null: no work. Call on_upkeep_done() with its
  /// result before the next call.
  std::function<Result<void>()> upkeep();
  void on_upkeep_done(const Result<void>& done);
  /// Makes running work stop early, without effect.
  void end_upkeep() { enough_.set(); }

 private:
  Ledger() = default;
  Result<void> append(const std::string& record, dispatch::Flush flush, bool has_new);
  Result<void> make_ready(std::size_t record);
  Result<void> begin();
  Result<void> begin_log();
  Result<void> begin_after_damage();

  std::shared_ptr<store::Directory> directory_;  // null: closed. Workers may hold it longer
  store::Contents contents_;                     // until log_ continues it
  std::unique_ptr<store::Log> log_;
  Book book_;
  std::string damage_, refusal_;
  LedgerFacts known_;  // from open()
  KnownFile file_;
  bool is_damaged_ = false, is_aside_ = false, has_turned_ = false, has_begun_ = false;
  bool is_under_way_ = false;                       // upkeep is running
  std::uint64_t snapshot_ = 0, next_snapshot_ = 0;  // first log after the last snapshot
  std::uint64_t spare_ = 0, next_spare_ = 0;        // the log with a spare file
  StopSource enough_;
};

}  // namespace adit::ledger

template <>
inline constexpr auto adit::store::kMembers<adit::ledger::LedgerFacts> = std::tuple(
    &adit::ledger::LedgerFacts::reports, &adit::ledger::LedgerFacts::log, &adit::ledger::LedgerFacts::last);
