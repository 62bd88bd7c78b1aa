#include "codec/gzip_whole.hpp"

#include <gtest/gtest.h>

#include "codec/messages.hpp"

namespace adit::codec {
namespace {

using test::Bytes;

constexpr std::size_t kEnough = std::size_t{1} << 24;

/// Of runs and noise, so that no level leaves it as it is.
Bytes mixed(std::size_t size) {
  std::mt19937_64 random(size);
  Bytes bytes(size, 255);
  for (std::size_t i = 0; i < size; i += 1 + random() % 40) bytes[i] = static_cast<std::uint8_t>(random());
  return bytes;
}

TEST(GzipWhole, MakesExactlyOneMemberAtEachLevel) {
  for (int level = kFastestLevel; level <= kSmallestLevel; ++level) {
    for (const std::size_t size : {0, 1, 100, 65'535, 65'536, 300'000}) {
      const Bytes bytes = mixed(size);
      const auto member = gzip_whole(bytes, level, kEnough);
      ASSERT_TRUE(member) << size;
      EXPECT_EQ(test::only_member(member->to_vector()), bytes) << level << " of " << size;
    }
  }
}

TEST(GzipWhole, IsNothingWhereItWouldTakeMore) {
  for (const int level : {kFastestLevel, 6, kSmallestLevel}) {
    const Bytes bytes = mixed(100'000);
    const std::size_t size = gzip_whole(bytes, level, kEnough)->size();
    for (const std::size_t less : {std::size_t{0}, std::size_t{1}, std::size_t{18}, size / 2, size - 1}) {
      EXPECT_FALSE(gzip_whole(bytes, level, less)) << less << " of " << size;
    }
  }
}

TEST(GzipWhole, FitsIntoWhatIsALittleMore) {
  const Bytes bytes = mixed(100'000);
  const auto free = gzip_whole(bytes, 6, kEnough);
  const auto tight = gzip_whole(bytes, 6, free->size() + 16);
  ASSERT_TRUE(tight);
  EXPECT_EQ(*tight, *free);
}

TEST(GzipWhole, OfNoiseIsNothingWithinItsOwnSize) {
  std::mt19937_64 random(1);
  Bytes noise(50'000);
  for (auto& byte : noise) byte = static_cast<std::uint8_t>(random());
  EXPECT_FALSE(gzip_whole(noise, kSmallestLevel, noise.size()));
  EXPECT_EQ(test::only_member(gzip_whole(noise, kSmallestLevel, kEnough)->to_vector()), noise);
}

TEST(GzipWhole, IsSmallerAtAHigherLevel) {
  const Bytes bytes = mixed(500'000);
  EXPECT_LT(gzip_whole(bytes, kSmallestLevel, kEnough)->size(), gzip_whole(bytes, 1, kEnough)->size());
}

}  // namespace
}  // namespace adit::codec
