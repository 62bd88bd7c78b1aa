#include "ledger/proof.hpp"

#include <array>
#include <bit>

namespace adit::ledger {
namespace {

/// A prime's powers, from the 0th on.
constexpr auto powers_of(std::uint64_t prime) {
  std::array<std::uint64_t, sizeof(std::uint64_t) + 1> powers{1};
  for (std::size_t i = 1; i < powers.size(); ++i) powers.at(i) = powers.at(i - 1) * prime;
  return powers;
}

std::string_view bytes_of(sqlite3_value* value) {
  const auto* const bytes = static_cast<const char*>(sqlite3_value_blob(value));
  return {bytes, bytes == nullptr ? 0 : static_cast<std::size_t>(sqlite3_value_bytes(value))};
}

void prove(sqlite3_context* context, int count, sqlite3_value** values) {
  Proof proof;
  for (int i = 0; i < count; ++i) {
    switch (sqlite3_value_type(values[i])) {
      case SQLITE_INTEGER:
        proof.add(std::int64_t{sqlite3_value_int64(values[i])});
        break;
      case SQLITE_FLOAT:
        proof.add(sqlite3_value_double(values[i]));
        break;
      case SQLITE_TEXT:
        proof.add_text(bytes_of(values[i]));
        break;
      case SQLITE_BLOB:
        proof.add_blob(bytes_of(values[i]));
        break;
      default:
        proof.null();
    }
  }
  sqlite3_result_int64(context, proof.value());
}

}  // namespace

/// The lowest byte first. A zero only multiplies, and most numbers end in many.
void Proof::number(std::uint64_t number) {
  std::size_t zeros = sizeof number;
  for (; number != 0; number >>= 8, --zeros) byte(static_cast<unsigned char>(number));
  static constexpr auto kPowers = powers_of(kPrime);
  hash_ *= kPowers.at(zeros);
}

void Proof::add(std::int64_t value) {
  byte('i');
  number(static_cast<std::uint64_t>(value));
}

void Proof::add(double value) {
  byte('r');
  number(std::bit_cast<std::uint64_t>(value == 0 ? 0.0 : value));  // SQLite keeps no sign of a zero
}

void Proof::add(char kind, std::string_view bytes) {
  byte(static_cast<unsigned char>(kind));
  number(bytes.size());
  for (const char each : bytes) byte(static_cast<unsigned char>(each));
}

std::int64_t Proof::value() const {
  return hash_ == kNoProof ? kNoProof + 1 : static_cast<std::int64_t>(hash_);
}

Result<void> teach_proof(Database& database) {
  constexpr int kHow = SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_DIRECTONLY;
  const int result = sqlite3_create_function_v2(database.get(), "proof", -1, kHow, nullptr, prove, nullptr,
                                                nullptr, nullptr);
  if (result != SQLITE_OK) return std::unexpected(database.error("adding the checksum function to SQLite"));
  return {};
}

}  // namespace adit::ledger
