#pragma once

#include <cstdint>
#include <expected>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "rehearsal/command_post/dates.hpp"
#include "rehearsal/command_post/json.hpp"
#include "rehearsal/known_cells.hpp"
#include "rehearsal/known_places.hpp"

namespace adit::rehearsal {

/// How old the maps were when they came, and how much of what was posted is here: of each robot and kind.
/// Bounded. Safe for use by several threads.
class Arrivals {
 public:
  /// A map was taken, whose last byte had come at `now`.
  void note(const MapMessage& map, Moment now);

  /// What adit-robots posted so far: [{"robot": "r1", "kind": "cloud", "amount": 1200, "places": 300,
  /// "newest": MS}], cells or points, places that have points (of grids none need be told), and the newest
  /// date in milliseconds since 1970. Rows of markers are skipped. The error is a sentence that names the
  /// field.
  std::expected<void, std::string> told(const Json& posted);

  /// An object for each robot and kind; ages in seconds. See README.md, 'How old'.
  OrderedJson json() const;

  /// The same as a table; "" where no map told a date.
  std::string table() const;

 private:
  struct Posted {
    std::uint64_t amount = 0, places = 0;
    Moment newest;
  };
  struct Arrived {
    std::uint64_t maps = 0;
    std::map<std::chrono::milliseconds, std::uint64_t> ages;  // how many maps were so old
    Moment newest;
    KnownCells cells;                        // of grids
    std::map<Moment, std::uint64_t> points;  // of clouds, by the date; the most that came in one map
    KnownPlaces places;
    std::optional<Posted> posted;

    std::uint64_t amount() const;
    double age(double share) const;  // seconds; that so many of the maps do not exceed
  };
  using Source = std::pair<std::string, std::string>;  // robot, kind

  Arrived* arrived(const std::string& robot, const std::string& kind);
  static OrderedJson row(const Source& source, const Arrived& arrived);

  mutable std::mutex mutex_;  // guards all below
  std::map<Source, Arrived> arrived_;
};

}  // namespace adit::rehearsal
