#pragma once

#include <expected>
#include <string>
#include <string_view>

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
/// Tolerated: stamps and lifetimes as {secs, nsecs}, integers for floats and whole floats for integers,
/// members that the ICD does not have, all-zero quaternions, absent or empty map names.

/// ICD 6.3, 6.4. Inflates `data` where the message says it is compressed, checks it, and leaves a grid's
/// cells as one gzip member and a cloud's points raw. CPU-bound in the size of the map: meant for a worker.
icd::Checked<icd::MapUpdate> read_map_update(Document document, const icd::Rules& rules);
/// ICD 6.5. Where a robot is named twice, its last pose counts.
icd::Checked<icd::StateUpdate> read_state_update(const Document& document, const icd::Rules& rules);
/// ICD 6.6. For actions 2 and 3, type, pose, scale and color may be absent.
icd::Checked<icd::MarkersUpdate> read_markers_update(const Document& document, const icd::Rules& rules);
/// ICD 5.2.
icd::Checked<icd::ArtifactReport> read_artifact_report(const Document& document, const icd::Rules& rules);

/// What the Command Post answered, or why it could not be understood.
std::expected<icd::RunStatus, std::string> read_run_status(std::string_view json);
std::expected<icd::ReportReply, std::string> read_report_reply(std::string_view json);

}  // namespace adit::codec
