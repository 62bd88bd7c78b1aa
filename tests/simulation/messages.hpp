#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/history.hpp"
#include "simulation/http.hpp"

namespace adit::simulation {

inline constexpr const char *kReports = "/api/artifact_reports", *kStatus = "/api/status",
                            *kMap = "/map/update", *kState = "/state/update", *kMarkers = "/markers/update";

/// What one message says of one thing, by the serial that rides in a field which nothing changes: a report's
/// x, a pose's x, a marker's scale, the points' intensity. A grid's cells show it, each by its value.
struct Item {
  std::string who;  // a map's or a pose's name, a marker's ns, "" of a report
  std::int64_t serial = 0;
  double stamp = 0;  // 0: none
  /// Of a grid its Extent, and upstream its cells, of a cloud its points, of a marker action and id, of a
  /// pose the number of the client that posts it.
  Says says = {};
};

/// Where a grid lies.
struct Extent {
  int centimetres = 50;       // of a cell
  int x = 0, y = 0;           // of the origin, in half cells
  int width = 8, height = 8;  // cells

  static Extent from(const Says& says) { return {says[0], says[1], says[2], says[3], says[4]}; }
  Says says() const { return {centimetres, x, y, width, height}; }
};
inline constexpr std::size_t kExtentNumbers = 5;
inline bool is_grid(const Says& says) {
  return says.size() >= kExtentNumbers;
}
inline bool is_cloud(const Says& says) {
  return says.size() == 1;
}
inline constexpr int kStrange = -1;                // points, a marker or a report: none that anybody posted
inline constexpr std::int64_t kOwnReports = 9000;  // serials from there on: of the operator's own
/// The serial of a correction, above that of the report that it corrects.
inline constexpr std::int64_t kCorrections = 10'000;

/// How the namespaces of markers end: of lines, and of long texts.
inline constexpr const char *kPath = " path", *kWriting = " writing";
enum MarkerAction { kAdd = 0, kDelete = 2, kDeleteAll = 3 };

/// Of a request to the Command Post; none where it is no message of the ICD.
std::vector<Item> items_of(const HttpMessage& request);
/// Of a status: its score, its remaining reports, and its run clock in milliseconds.
Says status_in(const std::string& body);

/// A client's message before it is put into bytes.
struct Posting {
  std::string path;
  /// Several markers of one stamp; or one thing, and behind it the clouds before it whose points it has, too.
  std::vector<Item> items;
};

struct Style {
  bool cbor = false, gzip = false, gzip_data = false;
  bool big_endian = false;  // clouds
  int point_step = 16;      // of clouds, in bytes
  bool news_first = false;  // of clouds that have the points of those before them
  bool rounds = false;      // a report's coordinates to float32
  bool in_rows = false;     // clouds are organised, and their rows padded
  double quaternion = 1;    // how long each is
};

/// What a client says of each thing in it.
std::vector<Event> events_of(const Posting& posting);
/// The whole request, in the bytes of that style. Reports are JSON.
std::string request_of(const Posting& posting, const Style& style);

}  // namespace adit::simulation
