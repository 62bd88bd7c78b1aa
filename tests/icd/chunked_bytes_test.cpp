#include "icd/chunked_bytes.hpp"

#include <gtest/gtest.h>

#include <random>
#include <thread>
#include <type_traits>

namespace adit::icd {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes counted(std::size_t size, std::uint8_t first = 0) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(first + i * 7);
  return bytes;
}

TEST(ChunkedBytes, KeepAppendedBytesOfAnyPieces) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 50; ++round) {
    Bytes expected;
    ChunkedBytes bytes;
    while (expected.size() < 200'000) {
      const Bytes piece = counted(random() % 90'000, static_cast<std::uint8_t>(random()));
      expected.insert(expected.end(), piece.begin(), piece.end());
      if (random() % 2 == 0) {
        bytes.append(piece);
      } else {
        bytes.append(Bytes(piece));
      }
    }
    EXPECT_EQ(bytes.to_vector(), expected);
    EXPECT_EQ(bytes.to_string(), std::string(expected.begin(), expected.end()));
    EXPECT_EQ(bytes.size(), expected.size());
    EXPECT_EQ(bytes, ChunkedBytes(expected));
    for (const auto& chunk : bytes.chunks()) {
      EXPECT_FALSE(chunk->empty());
      EXPECT_LE(chunk->size(), ChunkedBytes::kChunk);
    }
  }
}

TEST(ChunkedBytes, FillAChunkBeforeTheNext) {
  ChunkedBytes bytes;
  const Bytes piece = counted(100);
  for (int i = 0; i < 1000; ++i) bytes.append(piece);
  EXPECT_EQ(bytes.chunks().size(), 2U);
}

TEST(ChunkedBytes, ShareTheirChunksWithACopy) {
  const ChunkedBytes original(counted(100'000));
  const ChunkedBytes copy =
      original;  // NOLINT(performance-unnecessary-copy-initialization): the copy is the test
  EXPECT_EQ(copy.chunks()[0]->data(), original.chunks()[0]->data());
  EXPECT_EQ(copy.chunks()[1]->data(), original.chunks()[1]->data());
}

TEST(ChunkedBytes, DoNotChangeASharedChunk) {
  ChunkedBytes original(counted(10));
  ChunkedBytes copy = original;
  const ChunkedBytes::Chunk held = original.chunks()[0];
  const Bytes five = counted(5, 1);
  const Bytes three = counted(3, 2);
  original.append(five);
  copy.append(three);
  EXPECT_EQ(Bytes(held->begin(), held->end()), counted(10));
  EXPECT_EQ(original.size(), 15U);
  EXPECT_EQ(original.to_vector().size(), 15U);
  EXPECT_EQ(copy.to_vector().size(), 13U);
  EXPECT_EQ(copy.to_vector().back(), three.back());
}

TEST(ChunkedBytes, GrowTheirLastChunkOnceUnshared) {
  const Bytes piece = counted(10);
  ChunkedBytes bytes(piece);
  {
    const ChunkedBytes copy = bytes;
    bytes.append(piece);
    EXPECT_EQ(copy.to_vector(), piece);
  }
  bytes.append(piece);
  EXPECT_EQ(bytes.chunks().size(), 2U);
  EXPECT_EQ(bytes.size(), 30U);
}

/// Growing frees the bytes that the other thread has read. The thread sanitizer looks at the order.
TEST(ChunkedBytes, GrowTheirLastChunkOnceAnotherThreadHasReadIt) {
  const Bytes piece = counted(1000);
  ChunkedBytes bytes(piece);
  const std::jthread reader([&piece, copy = bytes]() mutable {
    EXPECT_EQ(copy.to_vector(), piece);
    copy = ChunkedBytes();
  });
  while (bytes.chunks()[0].owner().use_count() > 2) std::this_thread::yield();
  for (int i = 0; i < 10; ++i) bytes.append(piece);
  EXPECT_EQ(bytes.chunks().size(), 1U);
}

TEST(ChunkedBytes, AppendAChunkWithoutACopy) {
  Bytes chunk = counted(1000);
  const auto* where = chunk.data();
  ChunkedBytes bytes;
  bytes.append(std::move(chunk));
  EXPECT_EQ(bytes.chunks()[0]->data(), where);
}

TEST(ChunkedBytes, SplitATooLargeChunk) {
  ChunkedBytes bytes;
  bytes.append(counted(ChunkedBytes::kChunk + 1));
  EXPECT_EQ(bytes.chunks().size(), 2U);
  EXPECT_EQ(bytes.to_vector(), counted(ChunkedBytes::kChunk + 1));
}

TEST(ChunkedBytes, ShareTheChunksOfAnother) {
  ChunkedBytes first(counted(10));
  const ChunkedBytes second(counted(20));
  first.append(second);
  EXPECT_EQ(first.chunks()[1]->data(), second.chunks()[0]->data());
  const Bytes one = counted(1);
  first.append(one);
  EXPECT_EQ(second.to_vector(), counted(20));
  EXPECT_EQ(first.size(), 31U);
}

TEST(ChunkedBytes, CanBeAppendedToThemselves) {
  ChunkedBytes bytes(counted(10));
  bytes.append(bytes);
  Bytes twice = counted(10);
  const Bytes once = counted(10);
  twice.insert(twice.end(), once.begin(), once.end());
  EXPECT_EQ(bytes.to_vector(), twice);
}

TEST(ChunkedBytes, ArePoppedChunkByChunkFromTheFront) {
  const Bytes all = counted(3 * ChunkedBytes::kChunk + 5);
  ChunkedBytes bytes(all);
  Bytes popped;
  while (!bytes.empty()) {
    const std::size_t before = bytes.size();
    const ChunkedBytes::Chunk chunk = bytes.pop_front();
    popped.insert(popped.end(), chunk->begin(), chunk->end());
    EXPECT_EQ(bytes.size(), before - chunk->size());
    EXPECT_EQ(bytes.to_vector().size(), bytes.size());
  }
  EXPECT_EQ(popped, all);
  const Bytes four = counted(4);
  bytes.append(four);
  EXPECT_EQ(bytes.to_vector(), four);
}

TEST(ChunkedBytes, FreeAPoppedChunkOnceUnshared) {
  ChunkedBytes bytes(counted(2 * ChunkedBytes::kChunk));
  const std::weak_ptr<const void> first = bytes.chunks()[0].owner();
  bytes.pop_front();
  EXPECT_TRUE(first.expired());
}

TEST(ChunkedBytes, ReferToBytesOfAnOwnerAndKeepItAlive) {
  auto owner = std::make_shared<const Bytes>(counted(2 * ChunkedBytes::kChunk + 5));
  const std::weak_ptr<const Bytes> alive = owner;
  ChunkedBytes bytes(counted(3));
  bytes.append(owner, *owner);
  bytes.append(counted(4));
  ASSERT_EQ(bytes.chunks().size(), 5U);
  EXPECT_EQ(bytes.chunks()[1]->data(), owner->data());
  EXPECT_EQ(bytes.size(), owner->size() + 7);
  EXPECT_EQ(*owner, counted(2 * ChunkedBytes::kChunk + 5)) << "shared bytes must not change";
  owner.reset();
  const ChunkedBytes copy = bytes;
  while (!bytes.empty()) bytes.pop_front();
  EXPECT_FALSE(alive.expired());
  EXPECT_EQ(copy.to_vector().size(), 2 * ChunkedBytes::kChunk + 12);
}

TEST(ChunkedBytes, AreEqualIfTheirBytesAreEqual) {
  ChunkedBytes cut;
  cut.append(Bytes{1, 2});
  cut.append(Bytes{3});
  EXPECT_EQ(cut, ChunkedBytes(Bytes{1, 2, 3}));
  EXPECT_NE(cut, ChunkedBytes(Bytes{1, 2, 4}));
  EXPECT_NE(cut, ChunkedBytes(Bytes{1, 2}));
  EXPECT_EQ(ChunkedBytes(), ChunkedBytes(Bytes{}));
}

TEST(ChunkedBytes, AreEmptyOnceMovedFrom) {
  static_assert(std::is_nothrow_move_constructible_v<ChunkedBytes>);
  ChunkedBytes from(counted(10));
  const ChunkedBytes into = std::move(from);
  EXPECT_EQ(into.size(), 10U);
  EXPECT_TRUE(from.empty());  // NOLINT(bugprone-use-after-move): the header promises it
  EXPECT_TRUE(from.chunks().empty());
}

}  // namespace
}  // namespace adit::icd
