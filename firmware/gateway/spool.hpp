#pragma once

#include <string>
#include <vector>

#include "icd/map_update.hpp"
#include "icd/markers_update.hpp"
#include "icd/rules.hpp"
#include "icd/state_update.hpp"

namespace adit::gateway {

/// What was accepted and not yet forwarded when the service stopped.
struct Unsent {
  std::vector<icd::MapUpdate> maps;  // oldest news first
  icd::StateUpdate state;
  icd::MarkersUpdate markers;
};

/// Keeps what waits across a restart of the service (not of the box: the folder is in memory), one file a
/// message, each in the form that goes upstream.
class Spool {
 public:
  explicit Spool(std::string folder) : folder_(std::move(folder)) {}

  /// Writes all of it; what cannot be written is logged and lost.
  void save(const Unsent& unsent) const;
  /// Reads what save() wrote, and takes it away. What cannot be read is logged and set aside.
  Unsent take(const icd::Rules& rules) const;

 private:
  std::string folder_;
};

}  // namespace adit::gateway
