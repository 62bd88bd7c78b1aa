#include "store/contents.hpp"

#include <algorithm>
#include <utility>

#include "icd/try.hpp"

namespace adit::store {

/// Assembles the contents from the files.
class Assembly {
 public:
  Assembly(const Directory& directory, const LogOptions& keeping, std::uint64_t before)
      : directory_(directory), keeping_(keeping), before_(before) {}

  Result<Contents> run() {
    const auto files = ADIT_TRY(directory_.files());
    for (const FileName& file : files) {
      if (file.kind != FileName::Kind::Spare && file.number < before_) names_.push_back(file);
      contents_.number = std::max(contents_.number, file.number);
    }
    contents_.is_new = names_.empty();
    ADIT_TRY(scan_all());
    drop_void();
    for (const Scan& log : logs_) find_durable(log);
    for (const Scan& log : logs_) {
      if (!add_frames(log)) break;
    }
    finish();
    return std::move(contents_);
  }

 private:
  Result<Scan> scan_file(const FileName& name, const Layout& layout) {
    const auto most = ADIT_TRY(most_bytes(name, layout));
    auto bytes = ADIT_TRY(directory_.read(name.text(), most));
    if (const auto size = directory_.size(name.text()); size && *size > most)
      contents_.notes.push_back(name.text() + ": it has " + std::to_string(*size) +
                                " bytes, expected at most " + std::to_string(most) +
                                "; the rest was not read");
    Scan found = scan(name, contents_.bytes_.emplace_back(std::move(bytes)), layout);
    if (found.header && found.header->version > FileHeader::kVersion)
      return std::unexpected(Error{Error::Cause::Newer, name.text() + ": a later version wrote it"});
    contents_.process = std::max(contents_.process, found.process);
    return found;
  }

  Result<std::uint64_t> most_bytes(const FileName& name, const Layout& layout) const {
    if (!keeping_.syncs || name.kind != FileName::Kind::Log) return keeping_.most_bytes;
    const std::size_t room = layout.copies * room_of(FileHeader().to_bytes().size(), layout);
    const auto begin = ADIT_TRY(directory_.read(name.text(), room));
    const auto header = scan(name, begin, layout).header;
    return header && header->size > 0 ? header->size : keeping_.most_bytes;
  }

  Result<void> scan_all() {
    const auto logs_end = std::ranges::find(names_, FileName::Kind::Snapshot, &FileName::kind);
    contents_.bytes_.reserve(names_.size());
    std::optional<Scan> snapshot;  // the newest whole one, else the newest
    bool is_whole = false;
    for (auto name = names_.end(); name != logs_end;) {
      auto found = ADIT_TRY(scan_file(*--name, snapshot_layout(layout_)));
      is_whole = is_whole_snapshot(found);
      if (!is_whole) contents_.notes.push_back(found.name.text() + ": a damaged snapshot");
      if (is_whole || !snapshot) snapshot = std::move(found);
      if (is_whole) break;
    }
    for (auto name = names_.begin(); name != logs_end; ++name) {
      if (is_whole && name->number < snapshot->name.number) continue;
      auto found = ADIT_TRY(scan_file(*name, layout_));
      logs_.push_back(std::move(found));
    }
    if (snapshot) take_snapshot(*snapshot, is_whole);
    for (const Scan& log : logs_) contents_.logs.push_back(log.name.number);
    return {};
  }

  void take_snapshot(const Scan& snapshot, bool is_whole) {
    const bool has_first = !logs_.empty() && logs_.front().header && logs_.front().header->base == 0;
    if (!is_whole && has_first) return;  // the logs have all records
    std::erase_if(logs_, [&](const Scan& log) { return log.name.number < snapshot.name.number; });
    contents_.snapshot = snapshot.name.number;
    std::uint64_t next = 1;
    for (const Scan::FoundFrame& found : snapshot.frames) {
      if (found.frame.sequence != next) contents_.items.push_back(Gap{.file = snapshot.name.text()});
      next = found.frame.sequence + 1;
      if (found.frame.kind != kSnapshotEnds)
        contents_.items.push_back(Record{.kind = found.frame.kind, .body = found.frame.body});
    }
    if (snapshot.frames.empty() || snapshot.frames.back().frame.kind != kSnapshotEnds)
      contents_.items.push_back(Gap{.file = snapshot.name.text()});
    if (snapshot.header) {
      next_ = snapshot.header->base + 1;
    } else if (!logs_.empty() && logs_.front().header) {
      next_ = logs_.front().header->base + 1;
    }
    contents_.durable = next_ - 1;
    if (logs_.empty()) gap(next_, std::nullopt, snapshot.name);
  }

  /// Removes records that were written after a failed sync of their file. They were never acknowledged, and
  /// the next file's header says so.
  void drop_void() {
    std::uint64_t base = std::numeric_limits<std::uint64_t>::max();
    for (auto log = logs_.rbegin(); log != logs_.rend(); ++log) {
      std::erase_if(log->frames,
                    [base](const Scan::FoundFrame& found) { return found.frame.sequence > base; });
      if (log->header) base = std::min(base, log->header->base);
    }
  }

  void find_durable(const Scan& log) {
    if (log.header) contents_.durable = std::max(contents_.durable, log.header->base);
    for (const Scan::FoundFrame& found : log.frames)
      contents_.durable = std::max(contents_.durable, found.frame.durable);
  }

  /// A log on disk gets its name after its zeros are synced.
  std::uint64_t least_size(const Scan& log) const {
    if (log.header) return log.header->size;
    return keeping_.syncs ? std::min(keeping_.least_bytes, keeping_.file_bytes) : 0;
  }

  /// False: a frame is missing, and the rest was never synced.
  bool add_frames(const Scan& log) {
    if (log.size < least_size(log)) gap(next_, std::nullopt, log.name);
    for (const Scan::FoundFrame& found : log.frames) {
      const Frame& frame = found.frame;
      if (frame.sequence < next_) continue;
      if (frame.sequence > next_) {
        if (next_ > contents_.durable) return false;
        gap(next_, frame.sequence - 1, log.name);
      }
      contents_.items.push_back(Record{frame.sequence, frame.kind, frame.body});
      next_ = frame.sequence + 1;
      const bool was_synced = frame.sequence <= contents_.durable;  // otherwise a kill or a power cut tore it
      if (found.good < layout_.copies && was_synced)
        contents_.notes.push_back(log.name.text() + ": a damaged copy of record " +
                                  std::to_string(frame.sequence));
      if (found.good < layout_.copies || !was_synced)
        contents_.rewrites.push_back({log.name, found.offset, frame});
      if (&log == &logs_.back()) {
        if (first_here_ == 0) first_here_ = frame.sequence;
        contents_.end = found.offset + layout_.copies * room_of(frame.body.size(), layout_);
      }
    }
    return true;
  }

  void finish() {
    if (next_ <= contents_.durable)
      gap(next_, contents_.durable, logs_.empty() ? FileName() : logs_.back().name);
    contents_.last = std::max(next_ - 1, contents_.durable);
    if (logs_.empty()) return;
    const Scan& log = logs_.back();
    contents_.log = log.name;
    contents_.size = log.size;
    const std::uint64_t base = first_here_ == 0 ? contents_.last : first_here_ - 1;
    const std::string& body = contents_.bytes_.emplace_back(  // its size keeps a cut visible
        FileHeader{.number = log.name.number,
                   .salt = log.name.salt,
                   .base = base,
                   .size = keeping_.syncs ? std::max<std::uint64_t>(log.size, least_size(log)) : 0}
            .to_bytes());
    const Frame header =
        log.begin ? log.begin->frame : Frame{.kind = kFileBegins, .durable = base, .body = body};
    contents_.rewrites.push_back({log.name, 0, header});
    contents_.end = std::max(contents_.end, layout_.copies * room_of(header.body.size(), layout_));
  }

  void gap(std::uint64_t first, std::optional<std::uint64_t> last, const FileName& file) {
    contents_.items.push_back(Gap{first, last, file.text()});
  }

  const Directory& directory_;
  const LogOptions keeping_;
  const Layout layout_ = keeping_.layout;
  const std::uint64_t before_;
  std::vector<FileName> names_;
  std::vector<Scan> logs_;
  Contents contents_;
  std::uint64_t next_ = 1;        // expected sequence number
  std::uint64_t first_here_ = 0;  // of the last log
};

Result<Contents> Contents::read(const Directory& directory, const LogOptions& keeping, std::uint64_t before) {
  return Assembly(directory, keeping, before).run();
}

std::string FileHeader::to_bytes() const {
  std::string body;
  for (const std::uint64_t value : {version, number, salt, base, size}) put_number(body, value, 8);
  return body;
}

/// A later version may append numbers.
std::optional<FileHeader> FileHeader::parse(std::string_view body) {
  if (body.size() < 5 * 8) return std::nullopt;
  const auto value = [&body](std::size_t place) { return number_at(body, place * 8, 8); };
  return FileHeader{
      .version = value(0), .number = value(1), .salt = value(2), .base = value(3), .size = value(4)};
}

Scan scan(const FileName& name, std::string_view bytes, const Layout& layout) {
  Scan scan{.name = name, .size = bytes.size()};
  std::uint64_t newest = 0;
  for (std::size_t offset = 0; offset < bytes.size();) {
    const auto parsed = parse(bytes, offset, name.salt);
    if (!parsed) {
      offset = next_candidate(bytes, offset + 1, layout);
      continue;
    }
    const std::size_t room = room_of(parsed->frame.body.size(), layout);
    const std::size_t first = offset - std::min(offset, parsed->copy * room);
    offset += room;
    scan.process = std::max(scan.process, parsed->frame.process);
    if (parsed->frame.process < newest) continue;
    newest = parsed->frame.process;
    if (first == 0 && parsed->frame.kind == kFileBegins) {
      scan.header = FileHeader::parse(parsed->frame.body);
      scan.begin = Scan::FoundFrame{parsed->frame, first, parsed->copy + (scan.begin ? 1u : 0u)};
    } else if (!scan.frames.empty() && scan.frames.back().offset == first) {
      ++scan.frames.back().good;
    } else {
      scan.frames.push_back({parsed->frame, first, 1});
    }
  }
  return scan;
}

bool is_whole_snapshot(const Scan& scan) {
  if (!scan.header || scan.frames.empty() || scan.frames.back().frame.kind != kSnapshotEnds) return false;
  std::uint64_t next = 1;
  return std::ranges::all_of(
      scan.frames, [&next](const Scan::FoundFrame& found) { return found.frame.sequence == next++; });
}

}  // namespace adit::store
