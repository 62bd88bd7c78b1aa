#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "dispatch/merged_reports.hpp"
#include "dispatch/output.hpp"
#include "dispatch/report.hpp"
#include "dispatch/runs.hpp"
#include "ledger/book.hpp"
#include "store/contents.hpp"
#include "store/directory.hpp"
#include "store/frame.hpp"

namespace adit::ledger {

using store::Error;
using store::Result;

/// Facts about a ledger that are stored elsewhere. A ledger with less is damaged.
struct Known {
  std::int64_t reports = 0;  // count of numbers given out
  std::uint64_t log = 0;     // number of its last log; 0: unknown
  std::uint64_t last = 0;    // sequence number of its last record on the disk; 0: unknown

  friend bool operator==(const Known&, const Known&) = default;
};
Known latest_of(const Known& one, const Known& other);

/// All artifact reports with all their steps, and all runs, in a log on disk (store/README.md; records:
/// README.md). A successful write is on disk; a failed one has no effect.
class Ledger {
 public:
  static constexpr store::Keeping kKeeping{store::kOnDisk, 4u << 20, true};
  static constexpr const char* kDirectory = "ledger";       // below the state directory
  static constexpr const char* kMemory = "ledger-on-disk";  // below the runtime directory
  /// Bytes that a new report must leave in the file for steps of the known reports.
  static constexpr std::size_t kForKnown = 64u << 10;  // bytes

  /// Opens the ledger of a state directory, or creates one. If records are missing, also because a ledger in
  /// `known` is gone, each report that may have been sent becomes in doubt, and damage() says so. If the
  /// directory cannot be written, reports can be read, refusal() has the reason, and a later write may
  /// succeed. Error: unreadable, locked by another process, or from a later version; no file is changed.
  /// `memory`: a file in memory that always has known(), so that an older copy of the ledger is damage, too;
  /// "": none.
  static Result<Ledger> open(const std::string& state, const Known& known = {},
                             const std::string& memory = "");
  /// A ledger that cannot be read, for `why`. It has no reports and rejects new ones. known() has the latest
  /// of `known` and of the file `memory`, as in open().
  static Ledger closed(std::string why, const Known& known, const std::string& memory = "");
  /// Whether open() would succeed. Blocks on the disk; any thread.
  static bool can_be_read(const std::string& state);
  /// Renames an unreadable ledger, so that the next open() creates a new one. Returns the new name.
  static Result<std::string> set_aside(const std::string& state);
  Ledger(Ledger&&) noexcept;
  Ledger& operator=(Ledger&&) noexcept;
  ~Ledger();

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
  Result<void> make_ready();

  std::vector<dispatch::Report> reports() const;  // oldest first
  std::vector<dispatch::Run> runs() const;        // oldest first
  /// All steps of a report, oldest first.
  std::vector<Step> history(std::int64_t report) const;

  /// Reports, steps and runs as bytes for take_over(). Error if the ledger is closed.
  Result<std::string> copy() const;
  /// Whether the bytes are from copy().
  static bool is_copy(const std::string& copy);
  /// Takes over another box's reports and runs by dispatch::take_over(), with each report's history, as one
  /// record.
  Result<void> take_over(const std::string& copy, const dispatch::Handover& handover);

  /// A sentence about damage found by open(), or "".
  const std::string& damage() const;
  /// Why open() could not read the file in memory, so that an older copy may be believed; or "".
  const std::string& warning() const;
  /// Why the last try to accept a new report failed, or "".
  const std::string& refusal() const;
  bool is_closed() const;
  /// Facts to store elsewhere, never less than open() was given.
  Known known() const;

  /// Due work for another thread: a snapshot or a spare file. Null: no work. Call upkeep_done() with its
  /// result before the next call.
  std::function<Result<void>()> upkeep();
  void upkeep_done(const Result<void>& done);
  /// Makes running work stop early, without effect.
  void end_upkeep();

 private:
  class Impl;
  explicit Ledger(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::ledger

template <>
inline constexpr auto adit::store::kMembers<adit::ledger::Known> =
    std::tuple(&adit::ledger::Known::reports, &adit::ledger::Known::log, &adit::ledger::Known::last);
