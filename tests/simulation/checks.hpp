#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "dispatch/output.hpp"
#include "simulation/history.hpp"
#include "simulation/reader.hpp"

namespace adit::simulation {

constexpr double kLongestDoubt = 60;  // seconds

/// What both sides saw, and the contents of the box at the end, long after the last fault.
struct Evidence {
  const std::vector<Event>& events;
  const std::vector<dispatch::Report>& reports;  // of the ledger
  const std::vector<Reading>& readings;          // of the page
  std::size_t most_map_bytes = 0;                // limit of queued maps in the first settings
  std::size_t missing = 0;                       // records missing in the ledger
};

/// The window of the world's clock for a span from `first` to `last` of the box's clock. A power cut may
/// set the box's clock back; if anything else set it, the window is unbounded.
struct Window {
  double first = 0, last = 0;
  bool has(double at) const { return at > first && at < last; }
};
Window window_of(const Evidence& evidence, double first, double last);

/// Each check adds a sentence for each violation, which begins with the check's name. The checks read the
/// history of both sides and the ledger of the last process. Events that the history cannot order with a
/// reading count as either before or after it. If a client heard no answer, its request may have counted at
/// any time up to 12 s after the client was gone, or never. Two requests in flight at the same time may have
/// either order.
using Broken = std::vector<std::string>;
/// SettingsKept: A process starts with the settings whose saving was confirmed to an operator, or with later
/// ones.
void settings_kept(const Evidence& evidence, Broken& broken);
/// Starts: Each process starts.
void starts(const Evidence& evidence, Broken& broken);
/// Once: No report is recorded twice in a run. No report is recorded at a Command Post that the settings did
/// not name when it was posted, unless no run there was known, or was known only while the ledger could not
/// be written. No report is recorded in a run that began more than 25 s after its last posting, unless that
/// run has been on for less than 25 s. The operator's "send" counts as a posting. Two records may be
/// repeated: one in a stop, which does not count, and one that the operator sent while the course was
/// switched, because his decision was about the other course. A record within 60 s of a grant may be repeated
/// if its answer did not reach the disk and no status showed the grant. A record may also be repeated if the
/// clock was set back and the run got another name, before a second new name could show that the server
/// renames its runs.
void once(const Evidence& evidence, Broken& broken);
/// Addressed: While the status is a web page, no report is sent that the operator has not sent since the
/// start. After a redirect to the other form of the path, no report is sent to the old form in that process
/// and course, except after a 404.
void addressed(const Evidence& evidence, Broken& broken);
/// NotLost: If a client got 2xx, the report was recorded before. Each sent report is in the ledger at rest,
/// and the ledger has no gap; a second reader reads its files. Each report that the ledger calls answered, or
/// settled by evidence, was recorded. Exception: another sender reported while the report was in doubt, or up
/// to 60 s before, because both cases look the same (dispatch/README.md).
void not_lost(const Evidence& evidence, Broken& broken);
/// Paced: The first bytes of two requests of a URI leave at least 1 s apart, and so do their last bytes, also
/// over restarts. After a 429 the distance is at least its Retry-After (at most 30 s). So it is in one
/// process and course after a 503 to a map, a state or markers, and to a status while no report is open. A
/// connection whose line has no limit is given at least 1.5 MB/s, even if the last acknowledgement of each
/// message comes late. A report waits at most 1 s for a status in flight. A status leaves at least 1 s after
/// a report, unless one is in doubt. If a client asks for it, one leaves after at most three reports in a
/// row, unless the last one failed or a 429 came in this process. The distances are not checked after a power
/// cut, nor if a full runtime directory or a failed call there kept the times from being written or read.
void paced(const Evidence& evidence, Broken& broken);
/// These are parts of Paced.
void reports_go_first(const Evidence& evidence, Broken& broken);
void status_keeps_away(const Evidence& evidence, Broken& broken);
void status_has_its_turn(const Evidence& evidence, Broken& broken);
/// Learned: A Command Post that counts first or last bytes never answers 429 for a request that came too
/// soon. One that counts from its answers does so once per URI in 9 s at most, and twice per process. One
/// with a limit over reports and statuses does so once per process, unless a report is in doubt. Not checked
/// right after a power cut, nor if a full runtime directory or a failed call there kept the times from being
/// written or read.
void learned(const Evidence& evidence, Broken& broken);
/// OthersGoOn: While the states of one robot are rejected, at most four states in a row are rejected if
/// another robot (not a flood, which posts at once) had news before the first of them, in one process and
/// course.
void others_go_on(const Evidence& evidence, Broken& broken);
/// Stamps: The stamps of a URI never run back, over restarts and steps of the box's clock. No stamp is more
/// than 5 s ahead of the clock for stamps, which runs as the world's. Each power cut (and each new gateway
/// after one whose runtime directory was full) may set it ahead by 30 s more, or to the box's clock. Stamps
/// may run back below one that was sent less than 35 s after a fault of the disk. Until a power cut or such a
/// gateway, the stamp of a state is at least as far from the first stamp that a station posted for the robot
/// as the robot's own stamps are.
void stamps(const Evidence& evidence, Broken& broken);
/// Kept: A process never answers 200 to a request that a client begins after SIGTERM. Reports are excluded;
/// NotLost covers them.
void kept(const Evidence& evidence, Broken& broken);
/// Answered: A complete request is answered, or its connection closed, within 21 s (a report) or 8 s (others)
/// of its end or of the process's start. A stalled request is answered or closed within 17 s of its last byte
/// in the body, or 62 s in its head. Time for which the process stood still is added.
void answered(const Evidence& evidence, Broken& broken);
/// PoseArrived: At rest, the last accepted pose of a robot is the newest that Adit may have accepted. Poses
/// are ordered by stamp if one client stamped both by one clock and no other client's pose, no restart and no
/// switch of the course can have come between them, otherwise by the time of the post. If the client's clock
/// was set back, an older pose may stay until the clock has run on for 5 s, because newer poses with older
/// stamps may be a backlog (queues/stamps.hpp). After a status of another run, Adit sends no pose that was
/// delivered in that process, after its first status, and that was posted before that run, except after a
/// switch of the course.
void pose_arrived(const Evidence& evidence, Broken& broken);
/// GridArrived: The check replays the cells of all accepted grids, by name and lattice. After a 200, each
/// cell of the grid has the grid's value or a value that is not older, or lies, to half a cell and in height,
/// within a delivered grid on another lattice that is not older. A grid is also older if its client's clock
/// stamped it earlier and its upload began before the other one was whole. The cells of the other one count
/// then, to a whole cell, because it may have replaced a third. No older grid on another lattice was accepted
/// after it. Two exceptions: the older grid, with the grids that it replaced, had failed three times with
/// 5xx, so it let others pass (queues/map_queue.hpp); or it was rejected, and the operator sent it again.
/// Each cell has a value that a robot posted there, or is unknown if no grid was sent there in this run. A
/// run in which the clock was set back, or a report was granted, counts as the same run. A cell's value names
/// its grid, so the check needs no other source about stitched grids.
/// Replaced: No grid is sent for the first time if the queue had a newer grid then (accepted in this process,
/// before the second map before it left, and whole: no other grid overtook it) that contains it and all that
/// it may have replaced: to half a cell, and in height.
void grid_arrived(const Evidence& evidence, Broken& broken);
/// CloudArrived: All points of a cloud that was answered 200 are in one delivered cloud of its name, or in
/// the pieces of one, within the packing's 1.3 mm. A cloud is delivered again only after a kill, or if its
/// answer was lost or was not 200, or if it left before the other delivery and took long, or if the operator
/// sent it after a kill, or in pieces after a restart.
void cloud_arrived(const Evidence& evidence, Broken& broken);
/// MarkersArrived: The scene from the delivered changes is, marker for marker, one that the accepted changes
/// can make. A change that a newer one of its client overtook counts as earlier. A marker is sent with what
/// remains of its lifetime, to 4 s for a new connection, and only before its end. It is not deleted earlier
/// in its process. Lifetimes are not checked after an operator has sent a rejected message again.
void markers_arrived(const Evidence& evidence, Broken& broken);
/// Refused: A bad message is answered with the status that the ICD has for it, or with 408, 429 or 503. No
/// part of it goes upstream.
void refused(const Evidence& evidence, Broken& broken);
/// Clean: The rehearsal's reading of the ICD, which shares no code with the gateway's, finds no violation in
/// any request upstream.
/// Apart: Each socket to the Command Post, and each listening socket of the team, is bound to the interface
/// in the settings. If the settings name no interface for the team, as in half of the runs, the socket is not
/// bound.
void clean(const Evidence& evidence, Broken& broken);
/// StatusTrue: A client gets a status that the Command Post answered to a request at most 60 s ago, in this
/// process. Its Age is right to the second. It has exactly the effect of the reports that were answered
/// since. If the client asked after Adit had read a status, or an answer to a report, the status is at least
/// as new as these. After a sign of another run, answers may be left out.
void status_true(const Evidence& evidence, Broken& broken);
/// Decided: A report whose answer was lost long after the trouble is not left to the operator. Not checked
/// after another sender, a grant, a stop, or a clock that was set back, nor while clocks stand, nor if the
/// course was switched within 20 s of the loss or of the start after it.
void decided(const Evidence& evidence, Broken& broken);
/// Live: At rest no report is queued or being sent.
void live(const Evidence& evidence, Broken& broken);
/// NotCut: A request that began before settings were saved is neither cut afterwards nor answered that the
/// gateway stops, unless the gateway ends or restarts for another reason, or the client has ended its own
/// direction.
void not_cut(const Evidence& evidence, Broken& broken);
/// Honest: Compares readings of the page by one gateway, except for 12 s after a switch of the course.
/// Between two readings, the counts of accepted and forwarded messages, 429s and foreign answers grow by the
/// numbers in the history. A robot's age is that of its last delivered pose, until the box's clock was set.
/// Score, reports left and their age are those of the last status. A report that is called recorded is
/// recorded, with the points shown, unless another sender reported while it was in doubt, or up to 60 s
/// before it arrived. Scoring's last status is that of its last answer, or 0 with the reason why no answer
/// came. The metrics agree with the view. At rest, and not within 30 s of a start, no message is queued, and
/// the operator is called if and only if he has something to decide, or if reports are counted that Adit
/// cannot account for (another sender; a run without a name, or with another one in each answer).
void honest(const Evidence& evidence, Broken& broken);
/// Lights: A light shows what the panel's table says for the rest of the view, and is on or off as its steady
/// pattern says. It may be late by a second.
void lights(const Evidence& evidence, Broken& broken);
/// Obeyed: A report that the operator held, withdrew or corrected is not sent until he sends it or another
/// run begins. A report that he composed while reports.undo_s was on is not sent sooner; after a restart in
/// that time it is sent only after his word. From 5 s after reports.review was saved as all, a posted report
/// is sent only after his word. A report of his that was answered 202 is in the ledger.
void obeyed(const Evidence& evidence, Broken& broken);
/// Bounded: A process asks for at most 8.4 MB of memory at once, and has at most 25.2 MB at each reading of
/// the page and at its end, including the simulated world. A server has at most 64 connections, 8 of one
/// address that have shown a token and 16 that have not. At each reading, the page's lists have at most 200
/// (activities, reports), 100 (rejected) and 50 (refusals) rows. The state directory has at most 27.3 MB (and
/// 5.2 MB for each damaged ledger that was put aside with an alarm), the journal 2.6 MB, other files of the
/// runtime directory except maps 1.05 MB. Until other settings are saved, queued maps take at most
/// queues.map_bytes and one map that is queued again. At rest there is no map file. The journal and the map
/// files are not checked after a call failed in the runtime directory.
void bounded(const Evidence& evidence, Broken& broken);
/// OlderCopy: If a report was posted after a copy of the ledger, sent, and the copy was put back, the next
/// process that can read it reports the damage, in the log and by an alarm. The ledger reports at least as
/// many numbers as lost as it lacks such reports. If the runtime directory is kept, this covers all reports
/// sent before the process ended. If a power cut emptied it, if it was full, or if a kill tore the file in
/// it, this covers reports sent at least 12 s before the end. The disk must have had no fault in these 12 s,
/// nor at the start of that process. A power cut after the copy was put back also empties it, until a process
/// was READY without a fault of the disk, or found that all files can be read again. No process reports
/// damage of a ledger that has all its records. Other checks: a report that was sent later than that may be
/// recorded twice, may be missing, and its record counts as another sender's; a decision of the operator that
/// is later may be forgotten. A copy that lacks records ends the proof of the counts (Decided). Once,
/// NotLost, Obeyed and Honest hold for all others.
void older_copy(const Evidence& evidence, Broken& broken);
/// HasRoom: Only a flood, which has more connections than an address may have, gets an answer that it gave
/// way to another or that too many requests are in flight.
void has_room(const Evidence& evidence, Broken& broken);
/// Alive: READY comes before a process's first 200. STOPPING comes only after SIGTERM. From READY on systemd
/// hears from aditd at least every 10 s, plus the time for which the process stood still for its disk. STATUS
/// agrees with the view, late by a second at most.
void alive(const Evidence& evidence, Broken& broken);

/// The faults of the disk so far. Events are added in their order.
class DiskFaultsSeen {
 public:
  void add(const Event& event);
  /// Whether a gateway begins without state in the runtime directory: the one before could not write it, or
  /// this one cannot read it.
  bool forgets_at(const Event& event) const;
  /// Whether a fault is present, or ended less than `seconds` ago.
  bool within(double seconds, double now) const;

 private:
  std::set<std::string> on_;
  bool forgets_ = false;
  double last_ = -1e9;
};

/// Older copies of the ledger that were put back and lack records. The number of the last record outside
/// the ledger tells that. It has each step at once in memory, which a power cut clears, and later on the
/// disk.
class OlderCopies {
 public:
  struct PutBack {
    double copied = 0;       // when the copy was made
    double ended = 0;        // the process before
    double at = 0;           // when the copy was put back
    double known_until = 0;  // Adit must find that steps of a time up to this one are missing
    double on_disk = 0;      // the same, by the disk alone
  };
  explicit OlderCopies(const std::vector<Event>& events);
  const std::vector<PutBack>& all() const { return all_; }
  /// The copy that may have taken a step of this time, or null.
  const PutBack* taken_by(double step) const;
  /// Whether a step of this time may be missing at `now`, and Adit may not know that.
  bool may_forget(double step, double now) const;

 private:
  std::vector<PutBack> all_;
};
/// The reports that Adit has sent, by serial.
struct SentReports {
  SentReports(const std::vector<Event>& events, const OlderCopies& copies);
  std::map<std::int64_t, double> kept;  // must be in the ledger, with the time when each was sent
  std::set<std::int64_t> lost;          // Adit must find that they are missing
};
/// A record of a report that Adit has not sent, or has forgotten.
bool is_anothers(const Event& event, const OlderCopies& copies);
std::int64_t serial_of(const dispatch::Report& report);

Broken all_checks(const Evidence& evidence);

}  // namespace adit::simulation
