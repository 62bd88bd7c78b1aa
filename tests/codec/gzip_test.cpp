#include "codec/gzip.hpp"

#include <gtest/gtest.h>

#include "codec/messages.hpp"

namespace adit::codec {
namespace {

using test::Bytes;
using test::in_pieces;

Bytes noise(std::size_t size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Bytes bytes(size);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

Bytes runs(std::size_t size) {
  Bytes bytes(size, 255);
  for (std::size_t i = 0; i < size; i += 37) bytes[i] = static_cast<std::uint8_t>(i % 101);
  return bytes;
}

/// The result of gunzip, or its error sentence as bytes.
struct Inflated {
  Bytes bytes;
  std::size_t members = 0;
  std::string sentence;
};

Inflated inflate_all(const icd::ChunkedBytes& bytes, std::size_t most = 1U << 24U) {
  Inflated inflated;
  const auto size = gunzip(bytes, most, "msg.data", [&](std::span<const std::uint8_t> piece) {
    inflated.bytes.insert(inflated.bytes.end(), piece.begin(), piece.end());
    return icd::Checked<void>();
  });
  inflated.sentence = test::sentence_of(size);
  if (size) EXPECT_EQ(size->size, inflated.bytes.size());
  if (size) inflated.members = size->members;
  return inflated;
}

TEST(Gzip, MakesExactlyOneMember) {
  for (const auto strategy : {GzipStrategy::Default, GzipStrategy::Runs}) {
    for (const std::size_t size : {0, 1, 100, 65535, 65536, 65537, 1'000'000}) {
      for (const Bytes& bytes : {noise(size, size), runs(size)}) {
        const Bytes member = gzip(icd::ChunkedBytes(bytes), strategy).to_vector();
        EXPECT_EQ(test::only_member(member), bytes) << size;
      }
    }
  }
}

TEST(Gzip, MakesGridsSmall) {
  const Bytes cells = runs(1'000'000);
  EXPECT_LT(gzip(icd::ChunkedBytes(cells), GzipStrategy::Runs).size(), cells.size() / 8);
}

TEST(Gzipper, AcceptsPiecesOfAnySize) {
  const Bytes bytes = runs(200'000);
  Gzipper gzipper(GzipStrategy::Runs);
  for (std::size_t i = 0, size = 1; i < bytes.size(); i += size, size = size * 3 % 1009) {
    gzipper.feed(std::span(bytes).subspan(i, std::min(size, bytes.size() - i)));
  }
  EXPECT_EQ(test::only_member(gzipper.finish().to_vector()), bytes);
}

TEST(Gunzip, InflatesTheSameInAnyPieces) {
  const Bytes bytes = runs(300'000);
  const Bytes member = test::compressed(bytes);
  for (const std::size_t piece : {1, 7, 1000, 65536}) {
    const auto inflated = inflate_all(in_pieces(member, piece));
    EXPECT_EQ(inflated.sentence, "accepted");
    EXPECT_EQ(inflated.bytes, bytes);
  }
}

TEST(Gunzip, InflatesAnEmptyMember) {
  const auto inflated = inflate_all(icd::ChunkedBytes(test::compressed({})));
  EXPECT_EQ(inflated.sentence, "accepted");
  EXPECT_TRUE(inflated.bytes.empty());
}

TEST(Gunzip, RejectsTruncatedData) {
  const Bytes member = test::compressed(runs(1000));
  for (std::size_t size = 0; size < member.size(); ++size) {
    EXPECT_EQ(inflate_all(icd::ChunkedBytes(std::span(member).first(size))).sentence,
              "msg.data: expected a gzip member, got one that is cut short")
        << size;
  }
}

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST(Gunzip, JoinsSeveralMembersInAnyPieces) {  // RFC 1952 2.2
  const Bytes one = runs(100'000), other = noise(70'000, 1), nothing = test::compressed({});
  const Bytes members =
      joined({nothing, test::compressed(one), nothing, nothing, test::compressed(other), nothing});
  for (const std::size_t piece : {1, 7, 1000, 65536}) {
    const auto inflated = inflate_all(in_pieces(members, piece));
    EXPECT_EQ(inflated.sentence, "accepted") << piece;
    EXPECT_EQ(inflated.bytes, joined({one, other})) << piece;
    EXPECT_EQ(inflated.members, 6u) << piece;
  }
}

TEST(Gunzip, StopsABombOfMembersSoonAfterItsLimit) {
  const Bytes member = test::compressed(Bytes(900, 0));
  Bytes bomb;
  for (int i = 0; i < 10'000; ++i) bomb.insert(bomb.end(), member.begin(), member.end());
  const auto inflated = inflate_all(icd::ChunkedBytes(bomb), 1000);
  EXPECT_EQ(inflated.sentence, "413: msg.data: expected at most 1000 bytes, got more");
  EXPECT_EQ(inflated.bytes.size(), 900u);
}

TEST(Gunzip, RejectsOtherDataAfterAMember) {
  const Bytes member = test::compressed(runs(1000));
  const Bytes cut(member.begin(), member.end() - 1);
  Bytes damaged = member;
  damaged[damaged.size() - 5] ^= 1;
  for (const Bytes& more : {Bytes{0}, Bytes{1, 2, 3}, cut, damaged, Bytes(100'000, 0)}) {
    const Bytes both = joined({member, member, more});
    const std::string sentence = "msg.data: expected only gzip members after a gzip member, got " +
                                 std::to_string(more.size()) + " other bytes";
    EXPECT_EQ(inflate_all(icd::ChunkedBytes(both)).sentence, sentence);
    EXPECT_EQ(inflate_all(in_pieces(both, 5)).sentence, sentence);
    icd::ChunkedBytes apart{joined({member, member})};
    apart.append(Bytes(more));
    EXPECT_EQ(inflate_all(apart).sentence, sentence);
  }
}

TEST(Gunzip, RejectsOtherFormats) {
  const std::string start = "msg.data: expected a gzip member, got ";
  EXPECT_EQ(inflate_all(icd::ChunkedBytes(Bytes(100, 'a'))).sentence, start + "incorrect header check");
  EXPECT_EQ(inflate_all(icd::ChunkedBytes(test::compressed(runs(100), 15))).sentence,
            start + "incorrect header check");
  EXPECT_NE(inflate_all(icd::ChunkedBytes(test::compressed(runs(100), -15))).sentence, "accepted");
}

TEST(Gunzip, RejectsABadChecksumOrLength) {
  Bytes bad_sum = test::compressed(runs(1000));
  bad_sum[bad_sum.size() - 8] ^= 1;
  EXPECT_EQ(inflate_all(icd::ChunkedBytes(bad_sum)).sentence,
            "msg.data: expected a gzip member, got incorrect data check");
  Bytes bad_length = test::compressed(runs(1000));
  bad_length[bad_length.size() - 4] ^= 1;
  EXPECT_EQ(inflate_all(icd::ChunkedBytes(bad_length)).sentence,
            "msg.data: expected a gzip member, got incorrect length check");
}

TEST(Gunzip, StopsAGzipBombSoonAfterItsLimit) {
  const Bytes bomb = test::compressed(Bytes(10'000'000, 0));
  ASSERT_LT(bomb.size(), 20'000U);
  const auto inflated = inflate_all(icd::ChunkedBytes(bomb), 1000);
  EXPECT_EQ(inflated.sentence, "413: msg.data: expected at most 1000 bytes, got more");
  EXPECT_TRUE(inflated.bytes.empty());
}

TEST(ClaimedSize, IsReadFromAnyPieces) {
  for (const std::size_t size : {0, 1, 300, 100'000}) {
    const Bytes member = gzip(icd::ChunkedBytes(runs(size)), GzipStrategy::Runs).to_vector();
    for (const std::size_t piece : {1, 2, 3, 65536}) EXPECT_EQ(claimed_size(in_pieces(member, piece)), size);
  }
  EXPECT_EQ(claimed_size(icd::ChunkedBytes(Bytes{1, 2, 3})), 0u);
  EXPECT_EQ(claimed_size(icd::ChunkedBytes(Bytes{1, 2, 3, 0xff})), 0xff030201u);
}

TEST(Gunzip, AcceptsDataOfExactlyTheLimit) {
  const Bytes bytes = runs(100'000);
  EXPECT_EQ(inflate_all(icd::ChunkedBytes(test::compressed(bytes)), bytes.size()).sentence, "accepted");
  EXPECT_EQ(inflate_all(icd::ChunkedBytes(test::compressed(bytes)), bytes.size() - 1).sentence,
            "413: msg.data: expected at most 99999 bytes, got more");
}

TEST(Gunzip, StopsIfTheSinkRejectsData) {
  int calls = 0;
  const auto size = gunzip(icd::ChunkedBytes(test::compressed(runs(1'000'000))), 1U << 24U, "msg.data",
                           [&](std::span<const std::uint8_t>) -> icd::Checked<void> {
                             ++calls;
                             return std::unexpected(icd::Refusal{icd::Status::UnprocessableEntity, "no"});
                           });
  EXPECT_EQ(test::sentence_of(size), "no");
  EXPECT_EQ(calls, 1);
}

/// After any change of bytes, gunzip returns an error or bytes within its limit, and never crashes.
TEST(Gunzip, SurvivesDamage) {
  std::mt19937_64 random(3);
  const Bytes member = test::compressed(runs(5000));
  for (int round = 0; round < 3000; ++round) {
    Bytes damaged = member;
    for (int i = 0; i < 3; ++i) damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
    const auto inflated = inflate_all(in_pieces(damaged, 1 + random() % 200), 6000);
    EXPECT_LE(inflated.bytes.size(), 6000U);
    EXPECT_TRUE(inflated.sentence != "accepted" || inflated.bytes == runs(5000));
  }
}

}  // namespace
}  // namespace adit::codec
