#pragma once

#include <string>
#include <vector>

#include "archive/archive.hpp"
#include "icd/sentence.hpp"
#include "picture/maps.hpp"

namespace adit::archive {

/// A running run, as the gateway shows it to the archive.
struct ARun {
  Head head{.run = 3, .began = 990, .post = "10.100.1.200:8000"};
  picture::Easel easel;
  double clock_ahead = 0;  // seconds by which the time of day is ahead of the clock for stamps
  std::vector<api::Track> tracks{{"ugv1", {{.at = 1001, .position = {1, 2, 3}, .heading = 0.5}}}};
  Sample sample{.at = 1002, .sent_mbit = 1.5, .queued_bytes = 7, .scoring_ms = 12, .map_ages = {{"ugv1", 4}}};
  api::RunRow facts{.run = 3, .course = "alpha", .post = "10.100.1.200:8000", .began = 990, .score = 5};

  /// Draws maps of 16 m that do not compress, at a hundred different places.
  void draw(int maps, int from = 0) {
    for (int i = from; i < from + maps; ++i) {
      picture::Cells cells(std::size_t{64} * 64);
      unsigned random = static_cast<unsigned>(i) + 1;
      for (auto& cell : cells)
        cell = static_cast<std::uint8_t>((random = random * 1664525 + 1013904223) >> 24) % 101;
      easel.draw(picture::grid_at(64.0 * (i % 100), 0, 64, 0.25, cells));
    }
  }
  RunSnapshot seen() {
    sample.at = now();
    return {.now = now(),
            .stamp = stamp(),
            .picture = easel.mosaic,
            .tracks =
                [this](api::Time since) {
                  std::vector<api::Track> later;
                  for (const api::Track& track : tracks) {
                    if (!track.poses.empty() && track.poses.back().at > since) later.push_back(track);
                  }
                  return later;
                },
            .sample = [this] { return sample; },
            .facts = [this] { return facts; }};
  }
  double now() const { return easel.now + 10; }
  double stamp() const { return now() - clock_ahead; }
};

/// The picture as a page would show it: layers, tiles and times.
inline std::string shown(const picture::Mosaic& picture, std::optional<double> at = {}) {
  std::string all;
  for (const picture::LayerView& layer : picture.layers()) {
    all += layer.layer.robot + ' ' + std::to_string(static_cast<int>(layer.layer.kind));
    if (layer.bounds)
      all += ' ' + std::to_string(layer.bounds->left) + ".." + std::to_string(layer.bounds->right);
    for (const picture::TileView& tile : layer.tiles) {
      const auto seen = picture.tile(layer.layer, tile.at, at).tile;
      all += icd::sentence("; ", tile.at.level, ' ', tile.at.x, ' ', tile.at.y, ' ', seen ? seen->crc : 0);
    }
    all += '\n';
  }
  return all;
}

}  // namespace adit::archive
