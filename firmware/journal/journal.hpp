#pragma once

#include <atomic>
#include <cstddef>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "icd/markers_update.hpp"
#include "icd/state_update.hpp"
#include "icd/uri.hpp"
#include "journal/carried.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "store/contents.hpp"
#include "store/directory.hpp"
#include "store/log.hpp"

namespace adit::journal {

/// What must outlive any death of the service, though not of the machine: telemetry that was answered and is
/// not yet taken, when each URI was asked last, the stamps given out, and the senders' clocks. (README.md)
///
/// Each record is one write by the loop to a log in memory (store/README.md), and is there for the next
/// process once the call has returned. If there is no room for a record that nobody is answered for, it waits
/// in memory and is written before the next one. Until then the journal accepts no
/// other record.
class Journal {
 public:
  /// How the log is kept.
  static constexpr store::Keeping kKeeping{store::kInMemory, 0, false};
  /// Bytes of records that wait in memory, at most: those that come beyond are lost.
  static constexpr std::size_t kMostUnsaid = 8u << 20;
  /// A file is followed by the next one, and a snapshot is made, once it is as large as the last snapshot,
  /// and at least so large.
  static constexpr std::size_t kLeastTurn = 1u << 20;

  Journal(loop::Loop& loop, std::string folder);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The records of the processes before. If a file cannot be read, the files stay, the records are empty,
  /// and each append fails until the next start.
  Carried read();
  /// Why a file of the processes before cannot be read, or "".
  const std::string& unread() const { return unread_; }
  /// Whether the files in a journal's directory, if there is one, can be read now.
  static bool can_be_read(const std::string& folder);
  /// Which records of the processes before are damaged: a sentence, or "".
  const std::string& damage() const { return damage_; }
  /// Call once, after read() and before any other member.
  void begin(const Clock& clock);
  /// More is known of it.
  void clock(const Clock& clock) { note(Kind::Clock, store::bytes_of(clock)); }

  /// An error: it is not kept, and must not be answered as if it were.
  using Kept = std::expected<void, std::string>;
  Kept accepted(std::span<const lanes::PostedPose> poses) {
    return append(Kind::Poses, store::bytes_of(poses));
  }
  Kept accepted(const icd::MarkersUpdate& update) {
    return accepted_markers(store::bytes_of(update.markers));
  }
  /// The bytes of the markers. Any thread may make them.
  Kept accepted_markers(const std::string& bytes) { return append(Kind::Markers, bytes); }

  void senders(const lanes::StampShift::Clocks& clocks);
  /// For the next process start. If there is no room for it, the next one says the same.
  void heard(const Heard& heard) { (void)append(Kind::Heard, store::bytes_of(heard)); }

  /// These poses, or these markers, are about to be sent.
  void state_sent(const icd::StateUpdate& update) { note(Kind::StateSent, store::bytes_of(update.poses)); }
  void markers_sent(const icd::MarkersUpdate& update) { note(Kind::MarkersSent, names_of(update.markers)); }
  /// They need no more care, or wait again.
  void state_answered(bool done);
  void markers_answered(bool done);

  void paced(icd::Uri uri, const pace::Learned& learned) { note(Kind::Pace, store::bytes_of(uri, learned)); }
  void stamped(icd::Uri uri, icd::Stamp stamp) { note(Kind::Stamp, store::bytes_of(uri, stamp)); }
  /// Where grids are posted is told from here on; grids_posted() begins that, too.
  Kept grids_begin() { return append(Kind::Grids, {}); }
  Kept grids_posted(const std::string& name, const lanes::Extent& extent) {
    return append(Kind::Grids, store::bytes_of(name, extent));
  }

  /// Why the last record could not be kept, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  struct Unsaid {
    Kind kind;
    std::string said;
  };
  Kept open();
  void note(Kind kind, std::string said);
  /// What was sent waits again: nothing has happened, as long as it is unsaid that it was sent.
  void comes_back(Kind sent, Kind back);
  Kept append(Kind kind, std::string_view said);
  Kept append_unsaid();
  Kept write(Kind kind, std::string_view said);
  void compact();
  void not_compacted(const store::Error& error);
  Kept failed(const std::string& why);

  const std::string path_;
  std::optional<store::Directory> directory_;
  std::optional<store::Contents> contents_;  // of the processes before, until begin()
  std::optional<store::Log> log_;
  std::string unread_;  // why a file of the processes before could not be read
  std::string damage_;
  std::vector<Unsaid> unsaid_;  // in order
  std::size_t unsaid_size_ = 0;
  std::size_t size_ = 0, snapshot_ = 0;  // of the file, and of the last snapshot, in bytes
  std::size_t least_ = kLeastTurn;
  bool compacting_ = false;
  std::string trouble_;
  std::atomic<bool> ending_ = false;
  loop::Workers compactor_;  // a thread of its own: it may take a second, and nobody waits for it
};

}  // namespace adit::journal
