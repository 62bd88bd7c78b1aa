#pragma once

#include <string>
#include <string_view>

#include "icd/artifact_report.hpp"
#include "icd/chunked_bytes.hpp"
#include "icd/map_update.hpp"
#include "icd/markers_update.hpp"
#include "icd/state_update.hpp"

namespace adit::codec {

inline constexpr std::string_view kJson = "application/json";
inline constexpr std::string_view kCbor = "application/cbor";

/// The one canonical form of each message that goes upstream: CBOR (RFC 8949 4.1, preferred lengths) for the
/// mapping endpoint, with name, header {stamp, frame_id}, ns and id always there, and of a marker what the
/// ICD does not list only where it says something; JSON for scoring,
/// every <float> in the fewest digits that give the same double back, with a point or an exponent.

/// Shares the chunks of `update.data`; "compression" is "gzip" or "none" as update.data says.
icd::ChunkedBytes write_map_update(const icd::MapUpdate& update);

/// The same message in another order, its data first, so that the data can be written down before the rest is
/// known: `before`, always so long, then the data as update.data has it, then `after`, which ends with
/// checksum_of() both.
struct DataFirst {
  static constexpr std::size_t kBefore = 20, kChecksum = 4;
  std::string before, after;
};
DataFirst write_data_first(const icd::MapUpdate& update);
/// The CRC-32 of all but the data, `after` without its checksum; big-endian.
std::string checksum_of(std::string_view before, std::string_view after);

icd::ChunkedBytes write_state_update(const icd::StateUpdate& update);
icd::ChunkedBytes write_markers_update(const icd::MarkersUpdate& update);
std::string write_artifact_report(const icd::ArtifactReport& report);

/// `text` as a JSON string with its quotation marks (the body of every error reply, ICD 4). Bytes that are
/// not UTF-8 become U+FFFD.
std::string json_string(std::string_view text);

}  // namespace adit::codec
