#pragma once

#include <expected>
#include <string>

#include "icd/chunked_bytes.hpp"
#include "icd/map_update.hpp"
#include "icd/markers_update.hpp"
#include "icd/state_update.hpp"
#include "icd/status.hpp"

namespace adit::spool {

/// Messages in files of their own, in the form that goes upstream (codec/write.hpp). They outlive any death
/// of the process, not one of the machine: nothing is flushed.

/// Makes the folder, for this user alone, where there is none. What is wrong with it is found when something
/// is written there.
void make_folder_of_ours(const std::string& folder);

/// Writes a file, for this user alone, whole or not at all; each chunk is freed as it is written. An error
/// names the file, and leaves the one of that name as it was. For a writer.
std::expected<void, std::string> write_whole(const std::string& path, icd::ChunkedBytes bytes);

/// Removes what a kill left of files that were not written to their end. For nobody who still writes there.
void remove_parts(const std::string& folder);

/// Whether the files in a directory of messages, if there is one, can be read now.
bool can_be_read(const std::string& folder);

/// The message in a file, checked by the ICD's own rules: a team's (aliases, frames, sizes) were applied when
/// it came, and may be others by now. Refused with 503 if the file cannot be read, else because it is
/// damaged. A map's data is not read (MapFile::read()).
icd::Checked<icd::MapUpdate> read_map(const std::string& path);
icd::Checked<icd::StateUpdate> read_state(const std::string& path);
icd::Checked<icd::MarkersUpdate> read_markers(const std::string& path);

}  // namespace adit::spool
