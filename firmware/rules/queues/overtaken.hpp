#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "icd/grid_bounds.hpp"
#include "icd/map_update.hpp"
#include "icd/markers_update.hpp"
#include "queues/lattice.hpp"
#include "queues/sender.hpp"

namespace adit::queues {

/// The upload of a client's message. One message overtakes another one of the same client about the same
/// thing if it has a newer stamp and was accepted after the other one's upload had begun. Otherwise the
/// message whose upload began later is the newer one, whatever its stamp.
struct Upload {
  std::string address = {};
  std::size_t bytes = 0;  // of the body as received
  /// Places in the order in which uploads began and ended, from 1; 0: unknown.
  std::uint64_t began = 0, ended = 0;
  /// The first beginning of the client's other uploads that are not over; 0: there are none.
  std::uint64_t overlaps = 0;
};

/// The accepted maps that may overtake others, because their clients have other uploads that are not over.
class OvertakenMaps {
 public:
  static constexpr std::size_t kMostClients = 64, kMostOfClient = 256;

  /// The bounds of the accepted maps that overtook `map`. Of clouds they are empty.
  std::vector<icd::GridBounds> find_newer(const icd::MapUpdate& map, const Upload& upload) const;

  /// Whether a map is being stored that may have overtaken this upload, so that find_newer() is not known
  /// yet, or one that was overtaken itself and must be queued first.
  bool must_wait(const Upload& upload) const;
  /// A map is being stored; until end().
  void begin(const Upload& upload, bool is_overtaken) { stored_.push_back({upload, is_overtaken}); }
  void end(const Upload& upload);
  /// `map`, which has a stamp, was accepted.
  void record(const icd::MapUpdate& map, const Upload& upload);
  bool empty() const { return stored_.empty(); }

 private:
  struct Accepted {
    Sender sender;
    icd::Stamp stamp = 0;
    std::uint64_t ended = 0;
    icd::GridBounds bounds = {};
  };
  std::map<std::string, std::vector<Accepted>> clients_;  // by address
  struct Stored {
    Upload upload;
    bool is_overtaken = false;
  };
  std::vector<Stored> stored_;  // now
};

/// Rectangles of the cells of `older` that no newer grid covers. A cell is covered if its middle is
/// (icd::covered_part()). All cells of a grid that is too far away for corner_at().
std::vector<Cells> cells_outside(const icd::OccupancyGrid& older, std::span<const icd::GridBounds> newer);

/// The accepted changes of markers that may overtake others.
class OvertakenMarkers {
 public:
  static constexpr std::size_t kMostBytes = 1u << 20;  // as in icd::bytes_of(); beyond it, none are kept

  /// Removes the changes that newer changes of the same ns and id, or a newer DeleteAll, overtook. Behind a
  /// DeleteAll that newer changes overtook, it adds those that no other client has replaced. Returns the
  /// number of removed changes.
  std::size_t remove_from(icd::MarkersUpdate& update, const Upload& upload) const;
  /// `update`, which has stamps, was accepted.
  void record(const icd::MarkersUpdate& update, const Upload& upload);

 private:
  struct Change {
    icd::Marker marker;
    std::uint64_t ended = 0;
    bool stands = true;  // no later change of another client replaced it
  };
  struct Client {
    std::map<std::pair<std::string, std::int32_t>, Change> changes;  // by ns and id, after delete_all
    Change delete_all;
  };
  void replace_others(const icd::Marker& newer, const std::string& address);
  void forget(const std::string& address);

  std::map<std::string, Client> clients_;  // by address
  std::size_t bytes_ = 0;
};

}  // namespace adit::queues
