#pragma once

#include <atomic>
#include <cstdint>
#include <expected>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "icd/markers_update.hpp"
#include "icd/state_update.hpp"
#include "icd/uri.hpp"
#include "journal/carried.hpp"
#include "journal/folder.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"

namespace adit::journal {

/// What must outlive any death of the service, though not of the machine: telemetry that was answered and is
/// not yet taken, when each URI was asked last, the stamps given out, and the senders' clocks. (README.md)
///
/// Each call is one write() by the loop to a file that is in memory, and what it wrote is there for the next
/// life when it has returned, whatever happens to this one. What there is no room for and nobody is answered
/// for is said before what comes next: nothing is accepted where it is not known what became of all before.
class Journal {
 public:
  /// What waits to be said, at most: all that comes beyond is lost.
  static constexpr std::size_t kMostUnsaid = 8u << 20;
  /// A journal is begun again, beside its snapshot, once it is as large as that, and at least so large.
  static constexpr std::size_t kLeastTurn = 1u << 20;

  Journal(loop::Loop& loop, std::string folder);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The records of the processes before. If a file cannot be read, the files stay, the records are empty,
  /// and each append fails until the next start.
  Carried read();
  /// Call once, after read() and before any other member.
  void begin(const Clock& clock);
  /// More is known of it.
  void clock(const Clock& clock) { note(Kind::Clock, said(clock)); }

  /// An error: it is not kept, and must not be answered as if it were.
  using Kept = std::expected<void, std::string>;
  Kept accepted(std::span<const lanes::PostedPose> poses);
  Kept accepted(const icd::MarkersUpdate& update) { return accepted_record(record_of(update)); }
  /// Of markers, as record_of() made it.
  Kept accepted_record(const std::string& record) { return append(record); }

  void senders(const lanes::StampShift::Clocks& clocks);
  /// For the next process start. If there is no room for it, the next one says the same.
  void heard(const Heard& heard) { (void)append(framed(Kind::Heard, said(heard))); }

  /// These poses, or these markers, are about to be sent.
  void state_sent(const icd::StateUpdate& update);
  void markers_sent(const icd::MarkersUpdate& update);
  /// They need no more care, or wait again.
  void state_answered(bool done);
  void markers_answered(bool done);

  void paced(icd::Uri uri, const pace::Learned& learned);
  void stamped(icd::Uri uri, icd::Stamp stamp);
  /// Where grids are posted is told from here on; grids_posted() begins that, too.
  Kept grids_begin();
  Kept grids_posted(const std::string& name, const lanes::Extent& extent);

  /// Why the last record could not be kept, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  void note(Kind kind, std::string_view said) { keep(kind, framed(kind, said)); }
  /// A record, or several of one kind.
  void keep(Kind kind, std::string record);
  /// What was sent waits again: nothing has happened, as long as it is unsaid that it was sent.
  void comes_back(Kind sent, Kind back);
  Kept append(const std::string& record);
  std::string unsaid_and(const std::string& record) const;
  Kept write(std::string_view bytes);
  bool open_next();
  void turn_over();
  void compact(std::uint64_t last);
  Kept failed(const std::string& why);

  Folder folder_;
  std::string unread_;        // why a file of the processes before could not be read
  std::uint64_t number_ = 0;  // of the file that is written
  loop::FileDescriptor file_;
  struct Unsaid {
    Kind kind;
    std::string record;
  };
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
