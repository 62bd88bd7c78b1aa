#include "archive/said.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <memory>

namespace adit::archive {
namespace {

picture::Tile tile(std::string_view bytes) {
  auto tile = std::make_shared<picture::Packed>();
  tile->deflated.assign(bytes.begin(), bytes.end());
  tile->crc = 0x12345678;
  return tile;
}

const TileState kTile{{"ugv1", picture::Kind::Cloud}, {1, -3, 4}, 1000.5, tile("abc")};

TEST(Said, ATileComesBackAsItWas) {
  const auto read = read_tile(said(kTile));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->layer, kTile.layer);
  EXPECT_EQ(read->at, kTile.at);
  EXPECT_EQ(read->stamp, kTile.stamp);
  EXPECT_EQ(read->tile->deflated, kTile.tile->deflated);
  EXPECT_EQ(read->tile->crc, kTile.tile->crc);
  EXPECT_EQ(read_tile(said(TileState{kTile.layer, kTile.at, 1, nullptr}))->tile, nullptr);
}

TEST(Said, ALayerComesBackAsItWas) {
  picture::LayerView view;
  view.layer = {"r", picture::Kind::Grid};
  view.bounds = picture::Area{-1, -2, 3, 4};
  view.heights = picture::Heights{-0.5, 2};
  view.first = 10, view.last = 20, view.missed = 3, view.left_out = 4;
  const auto read = read_layer(said(view));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->layer, view.layer);
  EXPECT_EQ(read->bounds, view.bounds);
  EXPECT_EQ(read->heights, view.heights);
  EXPECT_EQ(read->first, 10);
  EXPECT_EQ(read->missed, 3U);
  EXPECT_FALSE(read_layer(said(picture::LayerView{}))->bounds);
}

TEST(Said, PosesSamplesAndWhatNeedsTheOperatorComeBackAsTheyWere) {
  const std::vector<api::TrackPose> poses{{.at = 1, .position = {2, 3, 4}, .heading = 5},
                                          {.at = 6, .position = {}}};
  const auto track = read_poses(said("ugv1", poses));
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
  EXPECT_EQ(read_sample(said(sample)), sample);
  const auto step = read_attention(said(api::AttentionStep{3, true, "no token"}));
  ASSERT_TRUE(step);
  EXPECT_TRUE(step->came);
  EXPECT_EQ(step->sentence, "no token");
  EXPECT_EQ(read_time(said_time(7)), 7);
}

TEST(Said, TilesOfAnotherCutDoNotFit) {
  const Head head{.run = 5, .began = 6, .post = "here:1"};
  std::string text = said(head);
  EXPECT_TRUE(read_head(text)->tiles_fit);
  text[text.size() - 1] ^= 1;  // metres per pixel
  EXPECT_FALSE(read_head(text)->tiles_fit);
  EXPECT_EQ(read_head(text)->head.post, "here:1");
}

TEST(Said, WhatIsTooLongIsCutBetweenCharacters) {
  std::string sentence(kMostText - 1, 'a');
  sentence += "\u00fc and more";
  EXPECT_EQ(read_attention(said(api::AttentionStep{1, true, sentence}))->sentence,
            std::string(kMostText - 1, 'a'));
}

/// Whatever bytes there are: read in full, or not at all.
TEST(Said, IsNothingWhereABytesIsWrongOrMissing) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(read_time(said_time(kNone)));
  EXPECT_FALSE(read_time(said_time(-1)));
  EXPECT_EQ(read_step(said(Step{-1, 5})), (Step{-1, 5}));
  EXPECT_FALSE(read_step(said(Step{kNone, 0})));
  EXPECT_FALSE(read_step(said(Step{-1e300, 0})));
  EXPECT_FALSE(read_poses(said("r", std::vector<api::TrackPose>{{.at = 1, .position = {kNone, 0, 0}}})));
  EXPECT_FALSE(read_tile(said(TileState{kTile.layer, {9, 0, 0}, 1, nullptr}))) << "no such level";
  EXPECT_FALSE(read_tile(said(TileState{kTile.layer, {0, 1 << 19, 0}, 1, nullptr}))) << "out of the world";
  EXPECT_FALSE(read_attention(said(api::AttentionStep{1, true, "\xff"}))) << "no UTF-8";
  const std::function<bool(std::string_view)> reads[] = {
      [](auto text) { return read_tile(text).has_value(); },
      [](auto text) { return read_layer(text).has_value(); },
      [](auto text) { return read_poses(text).has_value(); },
      [](auto text) { return read_sample(text).has_value(); },
      [](auto text) { return read_attention(text).has_value(); },
      [](auto text) { return read_head(text).has_value(); }};
  const std::string all[] = {said(kTile),
                             said(picture::LayerView{}),
                             said("r", std::vector<api::TrackPose>(2)),
                             said(Sample{.map_ages = {{"r", 1}}}),
                             said(api::AttentionStep{1, true, "s"}),
                             said(Head{})};
  for (std::size_t i = 0; i < std::size(all); ++i) {
    EXPECT_TRUE(reads[i](all[i])) << i;
    for (std::size_t cut = 0; cut < all[i].size(); ++cut)
      EXPECT_FALSE(reads[i](std::string_view(all[i]).substr(0, cut))) << i << " cut at " << cut;
    EXPECT_FALSE(reads[i](all[i] + 'x'));
  }
}

}  // namespace
}  // namespace adit::archive
