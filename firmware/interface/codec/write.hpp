#pragma once

#include <string>
#include <string_view>

#include "icd/chunked_bytes.hpp"
#include "icd/mapping.hpp"
#include "icd/scoring.hpp"

namespace adit::codec {

inline constexpr std::string_view kJson = "application/json";
inline constexpr std::string_view kCbor = "application/cbor";

/// The canonical form of each message to the Command Post. Mapping: CBOR (RFC 8949 4.1, preferred lengths),
/// always with name, header {stamp, frame_id}, ns and id; members of a marker outside the ICD only if set.
/// Scoring: JSON, each <float> in the fewest digits that preserve the double, with a point or exponent.

/// Shares the chunks of `update.data`. "compression" is "gzip" or "none", as in update.data.
icd::ChunkedBytes write_map_update(const icd::MapUpdate& update);

/// The same message with its data first, so that the data can be written before the rest is known: `before`,
/// of fixed size, the data as in update.data, then `after`, which ends with checksum_of() both.
struct DataFirst {
  static constexpr std::size_t kBefore = 20, kChecksum = 4;
  std::string before, after;
};
DataFirst write_data_first(const icd::MapUpdate& update);
/// The CRC-32 of all but the data, big-endian. `after`: without its checksum.
std::string checksum_of(std::string_view before, std::string_view after);

icd::ChunkedBytes write_state_update(const icd::StateUpdate& update);
icd::ChunkedBytes write_markers_update(const icd::MarkersUpdate& update);
std::string write_artifact_report(const icd::ArtifactReport& report);

/// The fewest digits that preserve the double, in the ICD's form of <float>: 11.0, not 11. "null" for NaN and
/// infinity, which messages never hold; the server would reject a needed field.
std::string json_number(double number);

/// `text` as a quoted JSON string (the body of error replies, ICD 4). Bytes that are not UTF-8 become U+FFFD.
std::string json_string(std::string_view text);

}  // namespace adit::codec
