#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "api/scene.hpp"
#include "codec/row.hpp"

namespace adit::api {

// What each member says, and its bounds, is in the descriptions: history.cpp.

/// How old the newest map is that the Command Post has of a robot, at each sample.
struct MapAges {
  std::string robot;
  std::vector<std::optional<double>> ages = {};

  static const codec::Row kRow;
};

/// Something that needed the operator: it came, or it went.
struct AttentionStep {
  Time at = 0;
  bool came = false;
  std::string sentence;

  static const codec::Row kRow;
};

/// The plots of a run. Each list has an item for each sample, oldest first.
struct History {
  double spacing = 0;
  std::vector<Time> at = {};
  std::vector<double> sent_mbit = {};
  std::vector<std::uint64_t> queued_bytes = {};
  std::vector<std::optional<double>> scoring_ms = {}, mapping_ms = {};
  std::vector<std::uint64_t> throttled = {};
  std::vector<MapAges> robots = {};
  std::vector<AttentionStep> attention = {};

  static const codec::Row kRow;
};

}  // namespace adit::api
