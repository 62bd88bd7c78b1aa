#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/history.hpp"
#include "simulation/http.hpp"

namespace adit::simulation {

inline constexpr const char *kReports = "/api/artifact_reports", *kStatus = "/api/status",
                            *kMap = "/map/update", *kState = "/state/update", *kMarkers = "/markers/update";

/// One item of a message. Its serial is in a field that Adit never changes: a report's x, a pose's x, a
/// marker's scale, the points' intensity. The values of a grid's cells show its serial.
struct Item {
  std::string who;  // a map's or a pose's name, a marker's ns, "" for a report
  std::int64_t serial = 0;
  double stamp = 0;  // 0: none
  /// A grid's Extent, and upstream its cells; the number of a cloud's points, and upstream the index of the
  /// first one and of the last one; a marker's action, id and lifetime in milliseconds; for a pose the number
  /// of the client that posts it.
  Says says = {};
};

/// The place of a grid, in millimetres.
struct Extent {
  int cell = 500;             // size of a cell, even
  int x = 0, y = 0;           // origin
  int width = 8, height = 8;  // cells
  int z = 0;

  static Extent from(const Says& says) { return {says[0], says[1], says[2], says[3], says[4], says[5]}; }
  Says says() const { return {cell, x, y, width, height, z}; }
};
inline constexpr std::size_t kExtentNumbers = 6;
inline bool is_grid(const Says& says) {
  return says.size() >= kExtentNumbers;
}
inline constexpr int kStrange = -1;                // points, a marker or a report that no client posted
inline constexpr std::int64_t kOwnReports = 9000;  // first serial of the operator's reports
/// Offset of a correction's serial from the serial of the report that it corrects.
inline constexpr std::int64_t kCorrections = 10'000;

/// Suffixes of the namespaces of markers: lines, and long texts.
inline constexpr const char *kPath = " path", *kWriting = " writing";
enum MarkerAction { kAdd = 0, kDelete = 2, kDeleteAll = 3 };

/// The items of a request to the Command Post; empty if it is not a message of the ICD.
std::vector<Item> items_of(const HttpMessage& request);
/// A status's score, its remaining reports, and its run clock in milliseconds.
Says status_in(const std::string& body);
/// Of the answer to a report: the serial of its report, 1 if it used up a report or else 0, its points, and
/// its run clock in milliseconds. Empty if it is no such answer.
Says reply_in(const std::string& body);

/// A client's message before it is serialised.
struct Posting {
  std::string path;
  /// Several markers of one stamp; or one item, followed by earlier clouds whose points it contains.
  std::vector<Item> items;
};

struct Style {
  bool cbor = false, gzip = false, gzip_data = false;
  bool big_endian = false;  // clouds
  int point_step = 16;      // of clouds, in bytes
  std::size_t noise = 0;    // bytes of noise in each point of a cloud, beyond point_step
  bool news_first = false;  // in clouds with points of earlier ones, the new points come first
  bool rounds = false;      // a report's coordinates are rounded to float32
  bool in_rows = false;     // clouds are organised, with padded rows
  double quaternion = 1;    // length of each
};

std::vector<Event> events_of(const Posting& posting);
/// The whole request in that style. Reports are JSON.
std::string request_of(const Posting& posting, const Style& style);

}  // namespace adit::simulation
