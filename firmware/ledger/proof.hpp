#pragma once

#include <cstdint>
#include <string_view>

#include "ledger/database.hpp"

namespace adit::ledger {

/// Where a row has no proof; nothing has this one. 0 is what a page reads as that was cut off.
inline constexpr std::int64_t kNoProof = 1;

/// A number that proves a row: made from all of its values, so that any byte of them that was changed by
/// damage shows. It guards against accidents, not against people.
class Proof {
 public:
  void null() { byte('n'); }
  void add(std::int64_t value);
  void add(double value);
  void add_text(std::string_view text) { add('t', text); }
  void add_blob(std::string_view bytes) { add('b', bytes); }
  /// Never kNoProof.
  std::int64_t value() const;

 private:
  void byte(unsigned char byte) { hash_ = (hash_ ^ byte) * kPrime; }
  void number(std::uint64_t number);
  void add(char kind, std::string_view bytes);

  static constexpr std::uint64_t kPrime = 0x100000001b3;  // FNV-1a's, of 64 bits
  std::uint64_t hash_ = 0xcbf29ce484222325;
};

/// Lets statements say proof(column, column...).
Result<void> teach_proof(Database& database);

}  // namespace adit::ledger
