#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "icd/map_update.hpp"
#include "icd/markers_update.hpp"
#include "icd/rules.hpp"
#include "icd/state_update.hpp"

namespace adit::gateway {

/// Keeps what waits across an end of the service, also a sudden one (not across an end of the box: the folder
/// is in memory), each message in the form that goes upstream. A message is there whole or not at all. What
/// cannot be written is logged, and waits in memory alone.
class Spool {
 public:
  struct Kept {
    std::vector<std::pair<std::uint64_t, icd::MapUpdate>> maps;  // by number
    icd::StateUpdate state;
    icd::MarkersUpdate markers;
  };

  /// Makes the folder, for this user alone.
  explicit Spool(std::string folder);

  /// Keeps a map until forget(). Safe to be called on a worker.
  void keep(std::uint64_t number, const icd::MapUpdate& map) const;
  void forget(std::uint64_t number) const;

  /// Keeps these in the place of those kept before; empty ones are forgotten.
  void keep(const icd::StateUpdate& state, const icd::MarkersUpdate& markers) const;

  /// All that is kept. What cannot be understood is logged and set aside.
  Kept read(const icd::Rules& rules) const;

 private:
  std::string file_of(std::uint64_t number) const;

  std::string folder_;
};

}  // namespace adit::gateway
