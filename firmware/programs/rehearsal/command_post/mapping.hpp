#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rehearsal/command_post/gate.hpp"

namespace adit::rehearsal {

/// The mapping endpoint of the ICD's section 6, to the letter. At most `hz` requests a second for each URI.
std::unique_ptr<Endpoint> strict_mapping(std::string token, double hz, Counted counted);

/// The public test server for mapping, as measured: see each rule in its source. At most `hz` clouds a
/// second, of all robots together.
std::unique_ptr<Endpoint> measured_mapping(std::string token, double hz, Counted counted);

/// A body for one of the mapping URIs, read.
struct MappingMessage {
  std::vector<Stamp> stamps;
  std::vector<Accepted> parts;
  std::optional<MapMessage> map;
  std::vector<MarkerChange> markers;
};

/// Reads the body of `judgement.uri` and writes down what is found. Leaves the document in judgement.message,
/// a map's data in it described, not kept. Nothing where there is no message.
std::optional<MappingMessage> read_mapping(const std::string& body, Format format, Judgement& judgement);

}  // namespace adit::rehearsal
