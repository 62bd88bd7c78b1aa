#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codec/body_decoder.hpp"
#include "icd/artifact_report.hpp"
#include "icd/map_update.hpp"
#include "icd/markers_update.hpp"
#include "icd/rules.hpp"
#include "icd/run_status.hpp"
#include "icd/state_update.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// Documents to messages that have passed every rule of the ICD. Each refusal is 422 and names the field.
/// Tolerated: stamps and lifetimes as ROS has them (Field::seconds()), integers for floats and whole floats
/// for integers, members that the ICD does not have, quaternions of any length, padding between the rows of a
/// cloud, absent or empty map names and frames, CBOR byte strings of UTF-8 for text.

/// ICD 6.3, 6.4. Inflates `data` where the message says it is compressed, checks it, and leaves a grid's
/// cells as one gzip member and a cloud's points raw and little-endian. CPU-bound in the size of the map:
/// meant for a worker.
icd::Checked<icd::MapUpdate> read_map_update(Document document, const icd::Rules& rules);
/// The map in a message of write_data_first(), whose data is in `data` and is not read: call check_data()
/// before the cells or points are used. Refused if the checksum is wrong: the message is damaged.
icd::Checked<icd::MapUpdate> read_data_first(std::string_view before, icd::ChunkedBytes data,
                                             std::string_view after, const icd::Rules& rules);
/// How many bytes of data follow `before`, which is DataFirst::kBefore bytes.
std::uint64_t data_after(std::string_view before);
/// Whether the data is what its map says. CPU-bound in the size of a grid: meant for a worker.
icd::Checked<void> check_data(const icd::MapUpdate& map);

/// What of a message was not taken, part by part.
struct RefusedParts {
  static constexpr std::size_t kMostToldOf = 10;

  std::size_t count = 0, others = 0;   // of the bad parts, and of the good ones
  std::vector<std::string> sentences;  // about the first bad ones
  std::string_view setting;            // icd::Refusal's, of the first of those that has one

  void add(icd::Refusal part) {
    if (++count > kMostToldOf) return;
    sentences.push_back(std::move(part.sentence));
    if (setting.empty()) setting = part.setting;
  }
  /// 422 with all its sentences, and what became of the others. Requires a bad part.
  icd::Refusal refusal() const;
};

/// The good parts of a message, and the others.
template <class Message>
struct InParts {
  Message message;
  RefusedParts refused;
};

/// ICD 6.5, 6.6: a state pose by pose, markers one by one, so that what one robot or program writes wrong
/// does not hide the others. Refused as a whole where the message around them is not good or where no part
/// is.
icd::Checked<InParts<icd::StateUpdate>> read_state_parts(const Document& document, const icd::Rules& rules);
icd::Checked<InParts<icd::MarkersUpdate>> read_markers_parts(const Document& document,
                                                             const icd::Rules& rules);

/// ICD 6.5. Where a robot is named twice, its last pose counts.
icd::Checked<icd::StateUpdate> read_state_update(const Document& document, const icd::Rules& rules);
/// ICD 6.6. For actions 2 and 3, type, pose, scale and color may be absent.
icd::Checked<icd::MarkersUpdate> read_markers_update(const Document& document, const icd::Rules& rules);
/// What a sentence says of a type that resembles one of the ten ("; did you mean Rope?"); "" of another.
using TypeHint = std::string (*)(std::string_view type);
struct ReadReport {
  icd::ArtifactReport report;
  std::string left_out;  // why it goes without its `name`; "": it has one, or none was given
};
/// ICD 5.2. A `name` that is no robot's is left out: a report is never refused for it.
icd::Checked<ReadReport> read_artifact_report(const Document& document, const icd::Rules& rules,
                                              TypeHint hint);

/// What the Command Post answered, or why it could not be understood.
std::expected<icd::RunStatus, std::string> read_run_status(std::string_view json);
std::expected<icd::ReportReply, std::string> read_report_reply(std::string_view json);

}  // namespace adit::codec
