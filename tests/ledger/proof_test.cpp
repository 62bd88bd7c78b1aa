#include "ledger/proof.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace adit::ledger {
namespace {

/// FNV-1a of 64 bits, byte by byte: what is in every ledger that was ever written.
std::int64_t fnv(const std::string& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char each : bytes) hash = (hash ^ static_cast<unsigned char>(each)) * 0x100000001b3;
  return static_cast<std::int64_t>(hash);
}

std::string little_endian(std::uint64_t number) {
  std::string bytes;
  for (int shift = 0; shift < 64; shift += 8) bytes += static_cast<char>(number >> shift);
  return bytes;
}

TEST(Proof, IsWhatItWasInEveryVersion) {
  std::vector<std::int64_t> numbers = {0, 1, -1, 255, 256, 65'536, INT64_MIN, INT64_MAX};
  for (int shift = 0; shift < 64; ++shift) numbers.push_back(static_cast<std::int64_t>(0xA5ULL << shift));
  for (const std::int64_t number : numbers) {
    Proof proof;
    proof.add(number);
    proof.add_text("a report");
    proof.add(2.5);
    EXPECT_EQ(proof.value(), fnv("i" + little_endian(static_cast<std::uint64_t>(number)) + "t" +
                                 little_endian(8) + "a report" + "r" + little_endian(0x4004000000000000)))
        << number;
  }
}

}  // namespace
}  // namespace adit::ledger
