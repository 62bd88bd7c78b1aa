#pragma once

#include <atomic>
#include <cstddef>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "icd/mapping.hpp"
#include "icd/uri.hpp"
#include "journal/carried.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "store/contents.hpp"
#include "store/directory.hpp"
#include "store/log.hpp"

namespace adit::journal {

/// Data that must survive a crash of the service, not of the machine: accepted telemetry that is not
/// delivered, the last request to each URI, used stamps, and senders' clocks (README.md).
///
/// Each record is one write by the loop to a log in memory (store/README.md); the next process finds it once
/// the call has returned. If there is no room for a record that no client's answer depends on, the record is
/// kept in this process and written before the next one. Until then the journal rejects all other records.
class Journal {
 public:
  /// Storage of the log.
  static constexpr store::Keeping kKeeping{store::kInMemory, 0, false};
  /// Most bytes of unwritten records; more are lost.
  static constexpr std::size_t kMostUnsaid = 8u << 20;
  /// Least size at which a snapshot is made. A snapshot is made when the file is larger than this and than
  /// the last snapshot.
  static constexpr std::size_t kLeastTurn = 1u << 20;

  Journal(loop::Loop& loop, std::string folder);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Records of earlier processes. If a file cannot be read, the files stay, the result is empty, and
  /// append() fails until the next start.
  Carried read();
  /// Why a file of earlier processes cannot be read, or "".
  const std::string& unread() const { return unread_; }
  /// Whether all files of a journal's directory, if it exists, can be read now.
  static bool can_be_read(const std::string& folder);
  /// A sentence about damaged records of earlier processes, or "".
  const std::string& damage() const { return damage_; }
  /// Call once, after read() and before any other member.
  void begin(const Clock& clock);
  /// Records a change of the clock.
  void clock(const Clock& clock) { note(Kind::Clock, store::bytes_of(clock)); }

  /// Error: not stored; the client must not get a success.
  using Kept = std::expected<void, std::string>;
  Kept accepted(std::span<const queues::PostedPose> poses) {
    return append(Kind::Poses, store::bytes_of(poses));
  }
  Kept accepted(const icd::MarkersUpdate& update);
  /// `record`: one of records_of() a message. If a later one fails, the next process sends the markers of the
  /// earlier ones although the client was refused; the client's next try replaces them.
  Kept accepted_markers(const std::string& record) { return append(Kind::Markers, record); }

  void senders(const queues::StampShift::Clocks& clocks);
  /// For the next process. A failed record is dropped, because the next one replaces it.
  void heard(const Heard& heard) { (void)append(Kind::Heard, store::bytes_of(heard)); }

  /// Call before these poses or markers are sent.
  void state_sent(const icd::StateUpdate& update) { note(Kind::StateSent, store::bytes_of(update.poses)); }
  void markers_sent(const icd::MarkersUpdate& update) { note(Kind::MarkersSent, names_of(update.markers)); }
  /// `done`: delivered or rejected; otherwise queued again.
  void state_answered(bool done);
  void markers_answered(bool done);

  void paced(icd::Uri uri, const pace::Learned& learned) { note(Kind::Pace, store::bytes_of(uri, learned)); }
  void stamped(icd::Uri uri, icd::Stamp stamp) { note(Kind::Stamp, store::bytes_of(uri, stamp)); }
  /// Starts the record of posted grids; grids_posted() does so too.
  Kept grids_begin() { return append(Kind::Grids, {}); }
  Kept grids_posted(const std::string& name, const queues::Extent& extent) {
    return append(Kind::Grids, store::bytes_of(name, extent));
  }

  /// Why the last record could not be stored, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  struct Unsaid {
    Kind kind;
    std::string said;
  };
  Kept open();
  void note(Kind kind, std::string said);
  /// Records that sent data is queued again. If the record of the sending is still unwritten, removes that
  /// record.
  void comes_back(Kind sent, Kind back);
  Kept append(Kind kind, std::string_view said);
  Kept append_unsaid();
  Kept write(Kind kind, std::string_view said);
  void compact();
  void not_compacted(const store::Error& error);
  Kept failed(const std::string& why);

  const std::string path_;
  std::optional<store::Directory> directory_;
  std::optional<store::Contents> contents_;  // of earlier processes, until begin()
  std::optional<store::Log> log_;
  std::string unread_;  // why a file of earlier processes could not be read
  std::string damage_;
  std::vector<Unsaid> unsaid_;  // in order
  std::size_t unsaid_size_ = 0;
  std::size_t size_ = 0, snapshot_ = 0;  // bytes of the file, and of the last snapshot
  std::size_t least_ = kLeastTurn;
  bool compacting_ = false;
  std::string trouble_;
  std::atomic<bool> ending_ = false;
  loop::Workers compactor_;  // its own thread, because a snapshot may take a second
};

}  // namespace adit::journal
