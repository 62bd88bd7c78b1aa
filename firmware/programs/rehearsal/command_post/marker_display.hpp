#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "rehearsal/command_post/findings.hpp"
#include "rehearsal/command_post/json.hpp"
#include "rehearsal/command_post/messages.hpp"

namespace adit::rehearsal {

/// The organiser's display of markers, as measured: after a message with fewer markers than the one before,
/// its server deletes the markers with an empty `ns` whose ids are the numbers that are missing. What stands
/// is compared with what the robots posted. Bounded. Safe for use by several threads.
class MarkerDisplay {
 public:
  /// Of a message that was taken. Writes down each marker that the server deletes by itself and that stands.
  void show(const std::vector<MarkerChange>& changes, Findings& findings);

  /// What adit-robots says that should stand, of each robot:
  /// [{"robot": "r1", "kind": "markers", "standing": [{"ns": "r1/path", "id": 3, "x": METRES}]}]. Rows of
  /// other kinds are skipped. The error is a sentence that names the field.
  std::expected<void, std::string> told(const Json& posted);

  /// How many stand, how many should, and sentences about the first that differ.
  OrderedJson json() const;
  /// The same as lines; "" if no robot told anything.
  std::string text() const;

 private:
  using Key = std::pair<std::string, std::int64_t>;  // ns, id
  using Places = std::map<Key, double>;              // x of each, metres

  std::vector<std::string> differences() const;

  mutable std::mutex mutex_;  // guards all below
  Places standing_;
  std::size_t before_ = 0;                // markers of the message before
  std::map<std::string, Places> posted_;  // by robot
};

}  // namespace adit::rehearsal
