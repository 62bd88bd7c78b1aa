#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace adit::ledger {

struct Blob {
  std::string bytes;
};
using Value = std::variant<std::monostate, std::int64_t, double, std::string, Blob>;
/// A row's values in the order of its table's columns, its number first, without its proof.
using Row = std::vector<Value>;

/// What could be had of a ledger row by row, whatever became of its structure.
struct Carved {
  std::map<std::int64_t, Row> reports, runs, sightings, robots;  // by number, each as it was last
  std::optional<std::int64_t> highest;                           // number of a report, by the mark
  bool unproven = false;  // rows of version 3's Adit are among them, which writes neither proofs nor the mark
};

/// Looks for rows in each page of the ledger's file and of its log, of whatever round, at each byte. A row is
/// taken that its proof proves, in the latest form of it: a report's history only grows, and a run was heard
/// last, as was what was seen of it. Of a ledger of version 3, which has no proofs, rows are taken that have
/// the form of one; likewise a row whose proof is none (tables.cpp), which that version wrote when it had its
/// turn again.
Carved carve(std::string_view file, std::string_view log);

}  // namespace adit::ledger
