#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dispatch/taking_over.hpp"
#include "ledger/record.hpp"
#include "store/contents.hpp"
#include "store/error.hpp"

namespace adit::ledger {

/// What the records of a ledger come to: each report as it was last, with all its steps, and each run.
class Book {
 public:
  struct Kept {
    std::string said, history;  // as records have them (record.hpp)
  };

  /// False: the record cannot be understood, and changed nothing.
  bool apply(std::uint8_t kind, std::string_view body);
  /// The same as a few records.
  std::vector<std::pair<std::uint8_t, std::string>> records() const;
  /// All reports and runs as one record's content.
  std::string copy() const;

  /// The record of these steps. An error: it would put a report in another's place, or what it says is no
  /// number.
  store::Result<std::string> record(std::span<const dispatch::Report> steps, const dispatch::Run* run) const;
  /// The record of a take-over from `there`.
  store::Result<std::string> record(const dispatch::TakeOver& taken, const Book& there) const;
  bool knows(std::int64_t report) const { return reports_.contains(report); }

  std::vector<dispatch::Report> reports() const;  // oldest first
  std::vector<dispatch::Run> runs() const;        // oldest first
  std::vector<Step> history(std::int64_t number) const;
  std::int64_t highest() const { return highest_; }

  /// For a log with missing records: each report without a final state is in doubt, and a report stands for
  /// each missing number. `expected`: at least so many numbers were given out. `end_is_lost`: the count of
  /// the last reports is unknown. A sentence about the reports that were read and those that are lost.
  std::string salvage(double now, std::int64_t expected, bool end_is_lost);

 private:
  using Reports = std::map<std::int64_t, Kept>;
  using Runs = std::map<std::int64_t, std::string>;
  /// One record of all these.
  std::string record_of(const Reports& reports, const Runs& runs) const;
  /// With the members of a later version that the run has here.
  std::string said_again(const dispatch::Run& run) const;
  void put(const dispatch::Report& report);
  void lose(std::int64_t last, const std::string& note, double now);

  Reports reports_;
  Runs runs_;
  std::int64_t highest_ = 0;
  std::vector<std::pair<std::uint8_t, std::string>> unknown_;  // records of a later version
};

/// What a log holds.
struct Reading {
  Book book;
  std::string gap = "";      // which records are missing, or ""
  bool end_is_lost = false;  // the last ones are
};
/// An error: a later version wrote a record that this one must understand.
store::Result<Reading> read(const store::Contents& contents);

}  // namespace adit::ledger
