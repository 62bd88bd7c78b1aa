#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dispatch/deeds.hpp"
#include "dispatch/report.hpp"

namespace adit::ledger {

struct Error {
  std::string what;
  bool full = false;  // the disk is full
};

template <class T>
using Result = std::expected<T, Error>;

/// What must survive: every artifact report and every step of its life, and the runs (SQLite, WAL,
/// synchronous=FULL; the format is in README.md). When a call has returned without an error, what it wrote is
/// on disk; when it has returned one, nothing of it is.
class Ledger {
 public:
  /// Opens or makes `folder`/ledger.sqlite, mode 0600. A file that is no ledger, or damaged, is set aside as
  /// ledger.sqlite.damaged-<n>, a new one is begun, and damage() says so. A ledger of an earlier version is
  /// brought up to this one; one of a later version is an error, and stays as it is.
  static Result<Ledger> open(const std::string& folder);
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
  /// The run with the highest number.
  Result<std::optional<dispatch::Run>> last_run() const;

  /// One step of a report's life. `state` is as it was written, whatever wrote it.
  struct Step {
    std::int64_t report = 0;
    double at = 0;  // seconds since 1970
    std::string state, note;
    friend bool operator==(const Step&, const Step&) = default;
  };
  /// All steps of one report, oldest first.
  Result<std::vector<Step>> history(std::int64_t number) const;

  /// A sentence about a ledger that was set aside at open(), or "".
  const std::string& damage() const;

 private:
  class Impl;
  explicit Ledger(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::ledger
