#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rehearsal/agreed.hpp"
#include "rehearsal/command_post/document.hpp"
#include "rehearsal/command_post/messages.hpp"

namespace adit::rehearsal {

/// For each robot and kind: the age of the maps at their arrival, and the share of the posted data that is
/// here; and the displayed markers, compared with the posted ones. Bounded. Safe for use by several threads.
class Arrivals {
 public:
  /// A map was taken, whose last byte had come at `now`.
  void note(const MapMessage& map, Moment now);

  /// Markers were taken. The organiser's display, as measured: after a message with fewer markers than the
  /// one before, its server deletes the markers with an empty `ns` whose ids are the numbers that are
  /// missing. Writes down each that it deletes so and that stands.
  void note(const std::vector<MarkerChange>& changes, Findings& findings);

  /// What adit-robots posted so far: [{"robot": "r1", "kind": "cloud", "amount": 1200, "places": 300,
  /// "newest": MS}], cells or points, places that have points (of grids none need be told), and the newest
  /// date in milliseconds since 1970; and what should stand, of each robot:
  /// {"robot": "r1", "kind": "markers", "standing": [{"ns": "r1/path", "id": 3, "x": METRES}]}. The error is
  /// a sentence that names the field.
  std::expected<void, std::string> told(const Json& posted);

  /// "maps", an object for each robot and kind, ages in seconds (README.md, 'How old'); and "markers": how
  /// many stand, how many should, and sentences about the first that differ.
  OrderedJson json() const;

  /// The same as tables; "" where no map told a date and no robot anything.
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
  using Key = std::pair<std::string, std::int64_t>;    // ns, id
  using Places = std::map<Key, double>;                // x of each, metres

  Arrived* arrived(const std::string& robot, const std::string& kind);
  bool told_maps(const Field& row);
  bool told_markers(const Field& row, const Field& standing);
  std::vector<std::string> differences() const;
  static OrderedJson row(const Source& source, const Arrived& arrived);

  mutable std::mutex mutex_;  // guards all below
  std::map<Source, Arrived> arrived_;
  Places standing_;
  std::size_t before_ = 0;                // markers of the message before
  std::map<std::string, Places> should_;  // by robot
};

}  // namespace adit::rehearsal
