#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dispatch/output.hpp"
#include "dispatch/report.hpp"
#include "dispatch/run.hpp"
#include "dispatch/taking_over.hpp"
#include "ledger/record.hpp"
#include "store/contents.hpp"
#include "store/error.hpp"

namespace adit::ledger {

using store::Error;
using store::Result;

/// Facts about a ledger that are stored elsewhere. A ledger that has less is damaged.
struct Known {
  std::int64_t reports = 0;  // so many numbers were given out
  std::uint64_t log = 0;     // number of its last log; 0: unknown
};

/// All artifact reports with every step of their lives, and all runs, in a log on the disk (store/README.md;
/// README.md has its records). A write that returns without an error is on the disk; one that returns an
/// error has no effect.
class Ledger {
 public:
  static constexpr store::Keeping kKeeping{store::kOnDisk, 4u << 20, true};
  static constexpr const char* kDirectory = "ledger";  // below the state directory
  /// A report is taken only if so much of the file is left behind it: for steps of the known reports.
  static constexpr std::size_t kForKnown = 64u << 10;  // bytes

  /// Opens the ledger of a state directory; makes one if the directory has none and `known` names none. If
  /// records are missing, each report that may have been sent is in doubt, and damage() says so. If the
  /// directory cannot be written, all reports can be read, and refusal() says why; a write may succeed later.
  /// An error if it cannot be read, another process has it open, or a later version wrote it; then no file
  /// has changed.
  static Result<Ledger> open(const std::string& state, const Known& known = {});
  /// One that cannot be read, for `why`: it has no report, and takes none.
  static Ledger closed(std::string why, const Known& known);
  /// Whether open() would succeed. Waits for the disk; for any thread.
  static bool can_be_read(const std::string& state);
  /// Renames a ledger that cannot be read, so that the next open() makes a new one. Its new name.
  static Result<std::string> set_aside(const std::string& state);
  Ledger(Ledger&&) noexcept;
  Ledger& operator=(Ledger&&) noexcept;
  ~Ledger();

  /// Writes all steps, in order, as one record: each report as it then is, its history with them. With Soon
  /// they outlive this process, and a power cut after the next write with Now, or flush(). What makes a
  /// report what it is (its type, position and time of receipt) never changes: a step that has others under
  /// a number that is in use is an error. `run`, if there is one, is written with them.
  Result<void> write(std::span<const dispatch::Report> steps, const dispatch::Run* run = nullptr,
                     dispatch::Flush flush = dispatch::Flush::Now);
  Result<void> write(const dispatch::Run& run) { return write({}, &run); }
  /// Syncs the writes with Soon.
  Result<void> flush();
  /// An error: a report that is new could not be written now.
  Result<void> make_ready();

  std::vector<dispatch::Report> reports() const;  // oldest first
  std::vector<dispatch::Run> runs() const;        // oldest first
  /// All steps of one report, oldest first.
  std::vector<Step> history(std::int64_t report) const;

  /// Reports, steps and runs as bytes for take_over(). An error if this is closed.
  Result<std::string> copy() const;
  /// Whether these bytes are such a copy.
  static bool is_copy(const std::string& copy);
  /// Takes over all that another box's ledger knows: dispatch::take_over(), with each report's history, as
  /// one record.
  Result<void> take_over(const std::string& copy, const dispatch::Handover& handover);

  /// A sentence about damage that was found by open(), or "".
  const std::string& damage() const;
  /// Why it takes no new report, by the last try, or "".
  const std::string& refusal() const;
  bool is_closed() const;
  /// To be kept elsewhere: never less than what open() was given.
  Known known() const;

  /// Work that is due, for another thread: a snapshot, or a spare file. Null: none. Call upkeep_done() with
  /// its result before asking again.
  std::function<Result<void>()> upkeep();
  void upkeep_done(const Result<void>& done);
  /// Work that is under way stops early, without effect.
  void end_upkeep();

 private:
  class Impl;
  explicit Ledger(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::ledger
