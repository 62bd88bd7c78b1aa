#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "rehearsal/command_post/geometry.hpp"

namespace adit::rehearsal {

/// Whether it is one of the types of the final event, in any letter case (ICD 5.2).
bool is_artifact_type(std::string_view type);

struct Artifact {
  std::string type;
  Point position;
  bool claimed = false;  // by a report that scored
};

/// A CSV of true artifacts: the header line "type,x,y,z", then one artifact a line, in metres. An error names
/// the line.
std::expected<std::vector<Artifact>, std::string> read_artifacts(const std::string& path);

/// Claims the nearest artifact of that type (in any letter case) which no report has claimed, if it is within
/// 5 m. Gives whether there was one.
bool claim(std::vector<Artifact>& artifacts, std::string_view type, const Point& position);

}  // namespace adit::rehearsal
