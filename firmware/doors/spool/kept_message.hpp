#pragma once

#include <expected>
#include <string>

#include "codec/field.hpp"
#include "icd/chunked_bytes.hpp"
#include "icd/grid_bounds.hpp"
#include "icd/mapping.hpp"
#include "icd/status.hpp"

namespace adit::spool {

/// Messages in files of their own, in the form of codec/write.hpp. The files survive a crash of the process,
/// not of the machine, because they are not flushed.

/// Creates the directory, readable by this user alone. Errors show when a file is written into it.
void make_folder_of_ours(const std::string& folder);

/// Writes a file for this user alone, completely or not at all, and frees each chunk once it is written. An
/// error names the file and leaves an older file unchanged. Writer thread.
std::expected<void, std::string> write_whole(const std::string& path, icd::ChunkedBytes bytes);

/// Removes unfinished files of a killed process. No writer may be active in the directory.
void remove_parts(const std::string& folder);

/// Whether all files of a message directory can be read now. A missing directory counts as readable.
bool can_be_read(const std::string& folder);

/// Reads a message and checks it by the ICD's own rules. The team's rules (aliases, frames, sizes) were
/// applied when it arrived and may have changed. Errors: 503 if the file cannot be read, otherwise the file
/// is damaged. A map's data is not read (MapFile::read()).
icd::Checked<icd::MapUpdate> read_map(const std::string& path);
icd::Checked<icd::StateUpdate> read_state(const std::string& path);
icd::Checked<icd::MarkersUpdate> read_markers(const std::string& path);

/// The bounds of a grid as a JSON list of numbers: left, bottom, lowest, right, top, highest, turned, along
/// the axes of the grid.
codec::Value to_json(const icd::GridBounds& bounds);
/// Reads them for `grid`. Bounds that are smaller than the grid are enlarged. Refuses damaged ones.
icd::GridBounds read_bounds(const codec::Field& field, const icd::OccupancyGrid& grid);

}  // namespace adit::spool
