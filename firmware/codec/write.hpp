#pragma once

#include <string>
#include <string_view>

#include "icd/artifact_report.hpp"
#include "icd/chunked_bytes.hpp"
#include "icd/map_update.hpp"
#include "icd/markers_update.hpp"
#include "icd/run_status.hpp"
#include "icd/state_update.hpp"

namespace adit::codec {

inline constexpr std::string_view kJson = "application/json";
inline constexpr std::string_view kCbor = "application/cbor";

/// The one canonical form of each message that goes upstream: CBOR (RFC 8949 4.1, preferred lengths) for the
/// mapping endpoint, with name, header {stamp, frame_id}, ns and id always there; JSON for scoring,
/// coordinates in the fewest digits that give the same double back.

/// Shares the chunks of `update.data`; "compression" is "gzip" or "none" as update.data says.
icd::ChunkedBytes write_map_update(const icd::MapUpdate& update);
icd::ChunkedBytes write_state_update(const icd::StateUpdate& update);
icd::ChunkedBytes write_markers_update(const icd::MarkersUpdate& update);
std::string write_artifact_report(const icd::ArtifactReport& report);

std::string write_run_status(const icd::RunStatus& status);

/// `text` as a JSON string with its quotation marks (the body of every error reply, ICD 4). Bytes that are
/// not UTF-8 become U+FFFD.
std::string json_string(std::string_view text);

}  // namespace adit::codec
