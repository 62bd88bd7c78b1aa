#include <gtest/gtest.h>

#include "codec/gzip.hpp"
#include "codec/messages.hpp"

namespace adit::codec {
namespace {

using test::Bytes;
using test::in_pieces;

constexpr std::size_t kEnough = std::size_t{1} << 24;

/// Runs and noise, so that every compression level changes it.
Bytes mixed(std::size_t size) {
  std::mt19937_64 random(size);
  Bytes bytes(size, 255);
  for (std::size_t i = 0; i < size; i += 1 + random() % 40) bytes[i] = static_cast<std::uint8_t>(random());
  return bytes;
}

TEST(GzipWhole, MakesExactlyOneMemberAtEachLevel) {
  for (int level = kFastestLevel; level <= kSmallestLevel; ++level) {
    for (const std::size_t size : {0, 1, 100, 65'535, 65'536, 150'000}) {
      const Bytes bytes = mixed(size);
      const auto member = gzip(bytes, level, kEnough);
      ASSERT_TRUE(member) << size;
      EXPECT_EQ(test::only_member(member->to_vector()), bytes) << level << " of " << size;
    }
  }
}

TEST(GzipWhole, FailsIfTheResultExceedsTheLimit) {
  for (const int level : {kFastestLevel, 6, kSmallestLevel}) {
    const Bytes bytes = mixed(100'000);
    const std::size_t size = gzip(bytes, level, kEnough)->size();
    for (const std::size_t less : {std::size_t{0}, std::size_t{1}, std::size_t{18}, size / 2, size - 1}) {
      EXPECT_FALSE(gzip(bytes, level, less)) << less << " of " << size;
    }
  }
}

TEST(GzipWhole, FitsIntoASlightlyLargerLimit) {
  const Bytes bytes = mixed(100'000);
  const auto free = gzip(bytes, 6, kEnough);
  const auto tight = gzip(bytes, 6, free->size() + 16);
  ASSERT_TRUE(tight);
  EXPECT_EQ(*tight, *free);
}

TEST(GzipWhole, FailsForNoiseWithinItsOwnSize) {
  std::mt19937_64 random(1);
  Bytes noise(50'000);
  for (auto& byte : noise) byte = static_cast<std::uint8_t>(random());
  EXPECT_FALSE(gzip(noise, kSmallestLevel, noise.size()));
  EXPECT_EQ(test::only_member(gzip(noise, kSmallestLevel, kEnough)->to_vector()), noise);
}

TEST(GzipWhole, IsSmallerAtAHigherLevel) {
  const Bytes bytes = mixed(500'000);
  EXPECT_LT(gzip(bytes, kSmallestLevel, kEnough)->size(), gzip(bytes, 1, kEnough)->size());
}

TEST(GunzipWhole, InflatesTheSameInAnyPieces) {
  for (const std::size_t size : {0, 1, 100, 300'000}) {
    const Bytes bytes = mixed(size), member = test::compressed(bytes);
    for (const std::size_t piece : {7, 1000, 65'536}) {
      EXPECT_EQ(gunzip(in_pieces(member, piece), size), bytes) << size;
    }
  }
}

TEST(GunzipWhole, RejectsAnotherSize) {
  const Bytes bytes = mixed(1000);
  const icd::ChunkedBytes member(test::compressed(bytes));
  for (const std::size_t size : {0, 1, 999, 1001, 100'000}) EXPECT_FALSE(gunzip(member, size)) << size;
}

TEST(GunzipWhole, RejectsTruncatedAndTrailingData) {
  const Bytes bytes = mixed(300), member = test::compressed(bytes);
  for (std::size_t size = 0; size < member.size(); ++size) {
    EXPECT_FALSE(gunzip(icd::ChunkedBytes(std::span(member).first(size)), bytes.size())) << size;
  }
  for (const Bytes& more : {Bytes{0}, Bytes{1, 2, 3}, member}) {
    Bytes both = member;
    both.insert(both.end(), more.begin(), more.end());
    EXPECT_FALSE(gunzip(icd::ChunkedBytes(both), bytes.size()));
  }
}

TEST(GunzipWhole, RejectsDamagedData) {
  const Bytes bytes = mixed(300), member = test::compressed(bytes);
  for (std::size_t i = 10; i < member.size(); ++i) {  // skips the head, whose bytes may be ignored
    Bytes damaged = member;
    damaged[i] ^= 0x10;
    const auto inflated = gunzip(icd::ChunkedBytes(damaged), bytes.size());
    EXPECT_TRUE(!inflated || *inflated == bytes) << i;
  }
}

}  // namespace
}  // namespace adit::codec
