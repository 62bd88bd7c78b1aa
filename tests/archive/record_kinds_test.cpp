#include "archive/record_kinds.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

namespace adit::archive {
namespace {

picture::Tile tile(std::string_view bytes) {
  auto tile = std::make_shared<picture::PackedTile>();
  tile->deflated.assign(bytes.begin(), bytes.end());
  tile->crc = 0x12345678;
  return tile;
}

const TileState kTile{{"ugv1", picture::LayerKind::Cloud}, {1, -3, 4}, 1000.5, tile("abc")};

/// A record's content as bytes.
std::string body_of(const Record& record) {
  std::string bytes;
  for_each_record(record_of(record), [&bytes](std::string_view body) { bytes = body; });
  return bytes;
}

template <class Of>
std::optional<Of> again(const Of& one) {
  const auto read_again = read(body_of(one));
  return read_again ? std::optional(std::get<Of>(*read_again)) : std::nullopt;
}

TEST(RecordBody, TileReadsBackTheSame) {
  const auto read = again(kTile);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->layer, kTile.layer);
  EXPECT_EQ(read->at, kTile.at);
  EXPECT_EQ(read->stamp, kTile.stamp);
  EXPECT_EQ(read->tile->deflated, kTile.tile->deflated);
  EXPECT_EQ(read->tile->crc, kTile.tile->crc);
  EXPECT_EQ(again(TileState{kTile.layer, kTile.at, 1, nullptr})->tile, nullptr);
}

TEST(RecordBody, LayerReadsBackTheSame) {
  picture::LayerView view;
  view.layer = {"r", picture::LayerKind::Grid};
  view.bounds = picture::Area{-1, -2, 3, 4};
  view.heights = picture::Heights{-0.5, 2};
  view.first = 10, view.last = 20, view.missed = 3, view.left_out = 4;
  const auto read = again(view);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->layer, view.layer);
  EXPECT_EQ(read->bounds, view.bounds);
  EXPECT_EQ(read->heights, view.heights);
  EXPECT_EQ(read->first, 10);
  EXPECT_EQ(read->missed, 3U);
  EXPECT_FALSE(again(picture::LayerView{})->bounds);
}

TEST(RecordBody, PosesSamplesAndAlarmsReadBackTheSame) {
  const auto track =
      again(api::Track{"ugv1", {{.at = 1, .position = {2, 3, 4}, .heading = 5}, {.at = 6, .position = {}}}});
  ASSERT_TRUE(track);
  EXPECT_EQ(track->robot, "ugv1");
  ASSERT_EQ(track->poses.size(), 2U);
  EXPECT_EQ(track->poses[0].position.z, 4);
  const Sample sample{.at = 2,
                      .sent_mbit = 0.5,
                      .queued_bytes = 9,
                      .scoring_ms = {},
                      .mapping_ms = 20,
                      .throttled = 1,
                      .map_ages = {{"", 3}, {"ugv1", 4}}};
  EXPECT_EQ(again(sample), sample);
  const auto step = again(api::AttentionStep{3, true, "no token"});
  ASSERT_TRUE(step);
  EXPECT_TRUE(step->came);
  EXPECT_EQ(step->sentence, "no token");
  EXPECT_EQ(again(WipeRecord{7})->stamp, 7);
}

TEST(RecordBody, TilesOfAnotherGeometryDoNotFit) {
  const Head head{.run = 5, .began = 6, .post = "here:1"};
  EXPECT_TRUE(again(head)->tiles_fit());
  Head other = head;
  other.pixel *= 2;
  EXPECT_FALSE(again(other)->tiles_fit());
  EXPECT_EQ(again(other)->post, "here:1");
}

TEST(RecordBody, LongTextIsCutBetweenCharacters) {
  std::string sentence(kMostText - 1, 'a');
  sentence += "\u00fc and more";
  EXPECT_EQ(again(api::AttentionStep{1, true, sentence})->sentence, std::string(kMostText - 1, 'a'));
}

/// Any bytes are read completely or not at all.
TEST(RecordBody, WrongOrMissingBytesAreRejected) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(again(WipeRecord{kNone}));
  EXPECT_FALSE(again(WipeRecord{-1}));
  EXPECT_EQ(again(Step{-1, 5}), (Step{-1, 5}));
  EXPECT_FALSE(again(Step{kNone, 0}));
  EXPECT_FALSE(again(Step{-1e300, 0}));
  EXPECT_FALSE(again(api::Track{"r", {{.at = 1, .position = {kNone, 0, 0}}}}));
  EXPECT_FALSE(again(TileState{kTile.layer, {9, 0, 0}, 1, nullptr})) << "no such level";
  EXPECT_FALSE(again(TileState{kTile.layer, {0, 1 << 19, 0}, 1, nullptr})) << "out of the world";
  EXPECT_FALSE(again(api::AttentionStep{1, true, "\xff"})) << "no UTF-8";
  for (const Record& one :
       {Record(kTile), Record(picture::LayerView{}), Record(WipeRecord{}), Record(Step{}),
        Record(api::Track{"r", std::vector<api::TrackPose>(2)}), Record(Sample{.map_ages = {{"r", 1}}}),
        Record(api::AttentionStep{1, true, "s"}), Record(Head{})}) {
    const std::string bytes = body_of(one);
    EXPECT_TRUE(read(bytes)) << one.index();
    for (std::size_t cut = 1; cut < bytes.size(); ++cut)
      EXPECT_FALSE(read(std::string_view(bytes).substr(0, cut))) << one.index() << " cut at " << cut;
    EXPECT_FALSE(read(bytes + 'x'));
  }
  EXPECT_FALSE(read("\x08")) << "a later kind";
}

}  // namespace
}  // namespace adit::archive
