#include <zlib.h>

#include "rehearsal/command_post/gate.hpp"
#include "rehearsal/command_post/mapping.hpp"

namespace adit::rehearsal {
namespace {

/// zlib's counter is 32 bits wide; no map's data is larger (kMostMapBytes).
unsigned long crc_of(const std::string& data) {
  return crc32(0, reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(data.size()));
}

/// Puts what `data` is in the place of what it holds.
void describe_data(Json& document, const std::optional<MapMessage>& map) {
  if (!document.is_object()) return;
  const auto msg = document.find("msg");
  if (msg == document.end() || !msg->is_object() || !msg->contains("data")) return;
  Json& data = (*msg)["data"];
  if (map) {
    data = {{"bytes", map->data.size()}, {"crc32", crc_of(map->data)}};
  } else {
    data = {{"unread", data.type_name()}};
  }
}

std::optional<MappingMessage> message_of(MapMessage&& map) {
  MappingMessage message;
  message.stamps = map.stamps;
  message.parts.push_back({std::holds_alternative<Grid>(map.msg) ? "grid" : "cloud", map.name});
  message.map = std::move(map);
  return message;
}

MappingMessage message_of(const std::vector<Stamp>& stamps, const char* kind,
                          const std::vector<std::string>& names) {
  MappingMessage message{.stamps = stamps, .parts = {}, .map = std::nullopt, .markers = {}};
  for (const std::string& name : names) message.parts.push_back({kind, name});
  return message;
}

}  // namespace

std::optional<MappingMessage> read_mapping(const std::string& body, Format format, Judgement& judgement) {
  Findings& findings = judgement.findings;
  auto read = read_document(body, format);
  if (!read) {
    const std::string name = format == Format::JsonText ? "JSON" : "CBOR";
    findings.breaks(name + " parsing failed: " + read.error(), Measured::Refuses, 400);
    return std::nullopt;
  }
  if (const auto& repeated = read->repeated) {
    findings.breaks("'" + *repeated + "' is given twice", Measured::Takes);
  }
  Json& document = judgement.message.emplace(std::move(read->value));
  if (document.is_object() && document.empty()) return std::nullopt;  // asks if the token is accepted
  if (judgement.uri == kMapUri) {
    auto map = read_map(document, format, findings);
    describe_data(document, map);
    return map ? message_of(std::move(*map)) : std::nullopt;
  }
  if (judgement.uri == kStateUri) {
    const auto state = read_state(document, findings);
    if (!state) return std::nullopt;
    return message_of(state->stamps, "pose", state->names);
  }
  auto markers = read_markers(document, findings);
  if (!markers) return std::nullopt;
  std::vector<std::string> names;
  for (const MarkerChange& change : markers->changes) names.push_back(change.ns);
  MappingMessage message = message_of(markers->stamps, "marker", names);
  message.markers = std::move(markers->changes);
  return message;
}

}  // namespace adit::rehearsal
