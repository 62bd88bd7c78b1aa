#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "rehearsal/command_post/document.hpp"

namespace adit::rehearsal {

/// A map's `data` inflates to no more than this, so that a bomb cannot fill the memory.
inline constexpr std::size_t kMostMapBytes = std::size_t{512} << 20;

/// ICD 6.3.1, without its cells.
struct Grid {
  double resolution = 0;
  std::uint32_t width = 0, height = 0;
  Placement origin;
};

/// ICD 6.3.2, without its points.
struct Cloud {
  std::optional<Placement> origin;
  std::vector<CloudField> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0;
};

/// POST /map/update (ICD 6.4).
struct MapMessage {
  std::string name;  // "": merged
  std::variant<Grid, Cloud> msg;
  std::string data;  // inflated
  std::vector<Stamp> stamps;
};

/// POST /markers/update (ICD 6.6): what each marker says of which one.
struct MarkerChange {
  std::string ns;
  std::int64_t id = 0;
  std::int64_t action = 0;
  double x = 0;  // metres
};

/// Reads a document and writes down all that the ICD or the measured server minds. Nothing where so much
/// is wrong that there is no message; a message that is there may still have decisive findings.
std::optional<MapMessage> read_map(const Json& document, Format format, Findings& findings);

struct Judgement;  // endpoint.hpp

struct AcceptedPart {
  std::string kind;   // "grid", "cloud", "pose", "marker", "report"
  std::string robot;  // a map's or a pose's name, a marker's ns; may be ""
};

/// A body for one of the mapping URIs, read.
struct MappingMessage {
  std::vector<Stamp> stamps = {};
  std::vector<AcceptedPart> parts = {};
  std::optional<MapMessage> map = {};
  std::vector<MarkerChange> markers = {};
};

/// Reads the body of `judgement.uri` and records its findings. Leaves the document in judgement.message, with
/// a map's data described, not stored. std::nullopt: no message. Requires a URI of kMappingFunctions.
std::optional<MappingMessage> read_mapping(const std::string& body, Format format, Judgement& judgement);

}  // namespace adit::rehearsal
