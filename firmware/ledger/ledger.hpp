#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dispatch/output.hpp"
#include "dispatch/report.hpp"
#include "dispatch/run.hpp"
#include "dispatch/taking_over.hpp"

namespace adit::ledger {

/// Why something could not be read or written.
struct Error {
  enum class Kind {
    Other,
    Full,      // the disk is full
    ReadOnly,  // the folder cannot be written to
    Failing,   // the disk itself reports errors
    Damaged,   // the file itself: no database, a broken one, or one without a ledger's tables
  };
  Kind kind = Kind::Other;
  std::string what = "";  // a sentence
};

template <class T>
using Result = std::expected<T, Error>;

/// What must survive: every artifact report and every step of its life, and the runs (SQLite, WAL,
/// synchronous=FULL; the format is in README.md). When a call has returned without an error, what it wrote is
/// on disk; when it has returned one, nothing of it is.
class Ledger {
 public:
  /// Opens or makes `folder`/ledger.sqlite, mode 0600. One that is damaged, or no ledger, is set aside as
  /// ledger.sqlite.damaged-<n>; what can be had of it is taken over row by row into a new one, which holds
  /// for the operator what may have been sent, and damage() says so. A log of which a byte is damaged is put
  /// right. A ledger of an earlier version is brought up to this one; one of a later version is an error, and
  /// stays as it is, unless that says that this one can work with it.
  static Result<Ledger> open(const std::string& folder);
  /// Where open() failed for `why` because the folder is full or cannot be written to: what can be read of
  /// its ledger, as a copy in a folder that is made below `scratch` and goes with this. It takes no write.
  static Result<Ledger> stand_in(const std::string& folder, const std::string& scratch,
                                 const std::string& why);
  /// Removes what a program that was killed has left of stand_in() below `scratch`, and of trials of
  /// `folder`; nothing of a ledger that is open.
  static void sweep(const std::string& folder, const std::string& scratch);
  /// Whether a folder that was full or could not be written to can be now, also for an upgrade or a salvage
  /// of the ledger in it. Waits for the disk.
  static bool can_be_opened(const std::string& folder);
  Ledger(Ledger&&) noexcept;
  Ledger& operator=(Ledger&&) noexcept;
  ~Ledger();

  /// Writes all steps, in order, as one transaction: each report as it then is, its history with them. One
  /// flush, or none where `flush` is Soon: then it outlives this program, and a power cut after the next
  /// write that is flushed, or flush(). What makes a report what it is (its type, position and time of
  /// receipt) never changes: a step that has others under a number that is in use is an error. `run`, where
  /// there is one, is written with them, as it now is.
  Result<void> write(std::span<const dispatch::Report> steps, const dispatch::Run* run = nullptr,
                     dispatch::Flush flush = dispatch::Flush::Now);
  Result<void> write(const dispatch::Run& run) { return write({}, &run); }

  /// How the next write is likely to be flushed: said where nobody waits for it, it need not be prepared
  /// then.
  void expect(dispatch::Flush flush);

  /// Flushes what was written without.
  Result<void> flush();

  /// All reports, oldest first. A state that this version does not know is read as InDoubt: only the operator
  /// can judge it.
  Result<std::vector<dispatch::Report>> reports() const;
  /// All runs, oldest first.
  Result<std::vector<dispatch::Run>> runs() const;

  /// One step of a report's life. `state` is the API's word, or a word that this version does not know.
  struct Step {
    std::int64_t report = 0;
    double at = 0;  // seconds since 1970
    std::string state, note;
    friend bool operator==(const Step&, const Step&) = default;
  };
  /// All steps of one report, oldest first.
  Result<std::vector<Step>> history(std::int64_t number) const;

  /// The whole ledger as one file's bytes, which open() reads wherever they are. An error, too, where this
  /// stands in for what cannot be read.
  Result<std::string> copy() const;
  /// Takes over all that `there`, another box's, knows: dispatch::take_over(), with each report's history, as
  /// one transaction and with one flush.
  Result<void> take_over(const Ledger& there, const dispatch::Handover& handover);

  /// A sentence about damage that was found at open(), or "".
  const std::string& damage() const;
  /// Why it takes no write at all (stand_in()), or "".
  const std::string& refusal() const;

 private:
  class Impl;
  explicit Ledger(std::unique_ptr<Impl> impl);
  static Result<Ledger> open_unlocked(const std::string& folder);
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::ledger
