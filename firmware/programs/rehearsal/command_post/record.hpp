#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <expected>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "rehearsal/agreed.hpp"
#include "rehearsal/command_post/document.hpp"
#include "rehearsal/command_post/endpoint.hpp"
#include "rehearsal/command_post/messages.hpp"
#include "rehearsal/command_post/run.hpp"

namespace adit::rehearsal {
/// Who sent a report: the "by" of each in the record.
inline constexpr const char* kByClient = "client";
inline constexpr const char* kByOther = "other sender";

/// A run's counts, reports and violations of the ICD. Bounded, whatever a peer sends. Thread-safe.
class Record {
 public:
  explicit Record(Manner manner) : manner_(manner) {}

  void note(std::uint64_t number, const Judgement& judgement);

  /// A report that was recorded, whoever sent it. They are kept in the order of their ids.
  void note_report(const OrderedJson& report);

  /// Why the measured mapping server died, or "".
  std::string killed_by() const;

  /// The record as GET /record gives it.
  OrderedJson json(const Run::Standing& standing) const;

  /// The same for a person to read.
  std::string summary(const Run::Standing& standing) const;

 private:
  using UriAndStatus = std::pair<std::string, int>;  // status 0: not answered
  using UriAndFault = std::pair<std::string, std::string>;
  using Part = std::tuple<std::string, std::string, std::string>;  // uri, kind, robot

  struct Violation {
    std::uint64_t number = 0;
    std::string uri;
    std::string sentence;
  };

  const Manner manner_;
  mutable std::mutex mutex_;
  std::map<UriAndStatus, std::uint64_t> requests_;
  std::map<Part, std::uint64_t> accepted_;
  std::map<UriAndFault, std::uint64_t> faults_;
  std::deque<OrderedJson> reports_;
  std::uint64_t report_count_ = 0;
  std::vector<Violation> violations_;
  std::uint64_t violation_count_ = 0;
  std::string killed_by_;
};

/// A folder for people: requests.jsonl, reports.jsonl, and map pictures in grids/ and clouds/. Thread-safe.
class Transcript {
 public:
  /// Makes `folder`, or appends to its transcript. After `most` bytes, writes only lines and no pictures.
  static std::expected<std::unique_ptr<Transcript>, std::string> open(const std::string& folder,
                                                                      std::uint64_t most);

  /// How many requests are written down.
  std::uint64_t requests() const { return requests_; }

  /// Writes a request, and the picture of its map. Shortens `judgement.message`.
  void request(std::uint64_t number, const char* endpoint, const Request& request, Judgement& judgement);
  void report(const OrderedJson& line) { append(reports_file_, line); }

 private:
  Transcript(std::string folder, std::uint64_t most) : folder_(std::move(folder)), most_(most) {}
  /// Writes a map's picture, and returns its name within the folder ("grids/000012-X1.pgm"). std::nullopt if
  /// the budget is used up or the disk is full.
  std::optional<std::string> picture(std::uint64_t number, const MapMessage& map);
  void append(std::ofstream& file, const OrderedJson& line);

  const Clock::time_point opened_ = Clock::now();
  const std::string folder_;
  const std::uint64_t most_;
  std::uint64_t requests_ = 0;
  std::mutex mutex_;
  std::uint64_t written_ = 0;
  bool complained_ = false;
  std::ofstream requests_file_;
  std::ofstream reports_file_;
};

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
  /// "newest": MS}], cells or points, places with points (optional for grids), and the newest date in
  /// milliseconds since 1970; and what should stand: {"robot": "r1", "kind": "markers", "standing": [{"ns":
  /// "r1/path", "id": 3, "x": METRES}]}. The error is a sentence that names the field.
  std::expected<void, std::string> set_expected(const Json& posted);

  /// "maps", an object for each robot and kind, ages in seconds (README.md, 'How old'); and "markers": how
  /// many stand, how many should, and sentences about the first that differ.
  OrderedJson json() const;

  /// The same as tables; "" if no map had a date and no robot told anything.
  std::string table() const;

 private:
  struct PostedAmount {
    std::uint64_t amount = 0, places = 0;
    Moment newest;
  };
  struct ReceivedMaps {
    std::uint64_t maps = 0;
    std::map<std::chrono::milliseconds, std::uint64_t> ages;  // how many maps were so old
    Moment newest;
    KnownCells cells;                        // of grids
    std::map<Moment, std::uint64_t> points;  // of clouds, by the date; the most that came in one map
    KnownPlaces places;
    std::optional<PostedAmount> posted;

    std::uint64_t amount() const;
    double age(double share) const;  // seconds; that so many of the maps do not exceed
  };
  using Source = std::pair<std::string, std::string>;  // robot, kind
  using Key = std::pair<std::string, std::int64_t>;    // ns, id
  using Places = std::map<Key, double>;                // x of each, metres

  ReceivedMaps* find_arrived(const std::string& robot, const std::string& kind);
  bool read_map_row(const Field& row);
  bool read_marker_row(const Field& row, const Field& standing);
  std::vector<std::string> differences() const;
  static OrderedJson row(const Source& source, const ReceivedMaps& arrived);

  mutable std::mutex mutex_;  // guards all below
  std::map<Source, ReceivedMaps> arrived_;
  Places standing_;
  std::size_t before_ = 0;                // markers of the message before
  std::map<std::string, Places> should_;  // by robot
};

}  // namespace adit::rehearsal
