#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codec/body_decoder.hpp"
#include "icd/mapping.hpp"
#include "icd/rules.hpp"
#include "icd/scoring.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// Read documents into messages that satisfy all rules of the ICD. Errors are 422 and name the field.
/// Tolerated: stamps and lifetimes in ROS's form (Field::seconds()), integers for floats and whole floats for
/// integers, unknown members, quaternions of any length, padding between rows of a cloud, absent or empty map
/// names and frames, CBOR byte strings of UTF-8 for text.

/// ICD 6.3, 6.4. Inflates compressed `data`, checks it, and leaves a grid's cells as one gzip member and a
/// cloud's points raw and little-endian. CPU time grows with the size of the map: use a worker.
icd::Checked<icd::MapUpdate> read_map_update(Document document, const icd::Rules& rules);
/// Reads the map of a write_data_first() message with unread data: call check_data() before using cells or
/// points. Error: the checksum is wrong, so the message is damaged.
icd::Checked<icd::MapUpdate> read_data_first(std::string_view before, icd::ChunkedBytes data,
                                             std::string_view after, const icd::Rules& rules);
/// Bytes of data after `before`, which must have DataFirst::kBefore bytes.
std::uint64_t data_after(std::string_view before);
/// Whether the data matches its map. CPU time grows with the size of a grid: use a worker.
icd::Checked<void> check_data(const icd::MapUpdate& map);

/// The refused parts of a message.
struct RefusedParts {
  static constexpr std::size_t kMostToldOf = 10;

  std::size_t count = 0, others = 0;   // number of bad parts, and of good ones
  std::vector<std::string> sentences;  // about the first bad parts
  std::string_view setting;            // icd::Refusal::setting, the first one set

  void add(icd::Refusal part) {
    if (++count > kMostToldOf) return;
    sentences.push_back(std::move(part.sentence));
    if (setting.empty()) setting = part.setting;
  }
  /// 422 with all sentences, and the result for the other parts. Requires a bad part.
  icd::Refusal refusal() const;
};

/// The good parts of a message, and the refused ones.
template <class Message>
struct CheckedParts {
  Message message;
  RefusedParts refused;
};

/// ICD 6.5, 6.6. Read a state by poses, and markers one by one, so that one sender's error does not hide the
/// others' parts. Error: the message around them is invalid, or all parts are.
icd::Checked<CheckedParts<icd::StateUpdate>> read_state_parts(const Document& document,
                                                              const icd::Rules& rules);
icd::Checked<CheckedParts<icd::MarkersUpdate>> read_markers_parts(const Document& document,
                                                                  const icd::Rules& rules);

/// ICD 6.5. If a robot is named twice, its last pose counts.
icd::Checked<icd::StateUpdate> read_state_update(const Document& document, const icd::Rules& rules);
/// ICD 6.6. For actions 2 and 3, type, pose, scale and color may be absent.
icd::Checked<icd::MarkersUpdate> read_markers_update(const Document& document, const icd::Rules& rules);
struct ReadReport {
  icd::ArtifactReport report;
  std::string left_out;  // why its `name` was left out, or ""
};
/// ICD 5.2. An invalid `name` is left out and does not refuse the report.
icd::Checked<ReadReport> read_artifact_report(const Document& document, const icd::Rules& rules);

/// The Command Post's answer, or why it cannot be read.
std::expected<icd::RunStatus, std::string> read_run_status(std::string_view json);
std::expected<icd::ReportReply, std::string> read_report_reply(std::string_view json);

}  // namespace adit::codec
