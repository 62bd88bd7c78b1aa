#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/http.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

inline constexpr const char *kReports = "/api/artifact_reports", *kStatus = "/api/status",
                            *kMap = "/map/update", *kState = "/state/update", *kMarkers = "/markers/update";

/// What one message says of one thing, by the serial that rides in a field which nothing changes: a report's
/// x, a pose's x, a marker's scale, the first cells of a grid.
struct Item {
  std::string who;  // a robot, or a marker's ns and id, or "" of a report
  std::int64_t serial = 0;
  double stamp = 0;  // 0: none
};

/// Of a request to the Command Post; none where it is no message of the ICD.
std::vector<Item> items_of(const HttpMessage& request);

/// A client's message before it is put into bytes.
struct Posting {
  std::string path;
  std::string who;
  std::int64_t serial = 0;
  double stamp = 0;  // by the sender's clock; 0: it gives none
  int size = 16;     // of a grid, in cells
};

struct Style {
  bool cbor = false, gzip = false, gzip_data = false;
};

/// The whole request, in the bytes of that style. Reports are JSON.
std::string request_of(const Posting& posting, const Style& style);

}  // namespace adit::simulation
