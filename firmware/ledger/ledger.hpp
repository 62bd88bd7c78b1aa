#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "icd/artifact_report.hpp"

namespace adit::ledger {

/// One report as it is on disk. `state` is the dispatch room's word for where it is in its life.
struct Entry {
  std::int64_t number = 0;  // Adit's own, from 1, never used twice
  icd::ArtifactReport report;
  std::string sender;   // address of who posted it
  double received = 0;  // seconds since 1970
  double changed = 0;
  std::string state;
  int status = 0;            // the Command Post's answer; 0: none yet
  std::string content_type;  // of that answer
  std::string answer;        // its body, byte for byte
  std::string note;          // a sentence for the operator: why it is where it is
};

struct Error {
  std::string what;
  bool full = false;  // the disk is full
};

template <class T>
using Result = std::expected<T, Error>;

/// What must survive: every artifact report and every step of its life (SQLite, WAL, synchronous=FULL). When
/// a call has returned without an error, what it wrote is on disk.
class Ledger {
 public:
  /// Opens or makes `folder`/ledger.sqlite, mode 0600. A file that is no ledger, or damaged, is set aside as
  /// ledger.sqlite.damaged-<n>, a new one is begun, and damage() says so.
  static Result<Ledger> open(const std::string& folder);
  Ledger(Ledger&&) noexcept;
  Ledger& operator=(Ledger&&) noexcept;
  ~Ledger();

  /// Records a new report and gives its number.
  Result<std::int64_t> add(const icd::ArtifactReport& report, const std::string& sender,
                           const std::string& state, double now);
  /// Records a step: `entry.state`, status, content_type, answer and note of the report `entry.number`.
  Result<void> change(const Entry& entry, double now);

  /// All reports, oldest first.
  Result<std::vector<Entry>> all() const;
  Result<std::optional<Entry>> find(std::int64_t number) const;

  /// A sentence about a ledger that was set aside at open(), or "".
  const std::string& damage() const;

 private:
  class Impl;
  explicit Ledger(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::ledger
