#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace adit::simulation {

enum class Actor : std::uint8_t { Team, Adit, Post, Disk };

/// Kinds of events. An event with a serial is about that message.
enum class Kind : std::uint8_t {
  Invoke,     // a client begins a request; one event for each item
  Whole,      // the last byte of its request was sent
  Stalls,     // it stops within the request and waits
  Answered,   // the client has heard a complete answer with that status
  Gone,       // the connection ended without a complete answer
  Leaves,     // the first byte of a request upstream was given to the network
  Complete,   // the last byte was
  Left,       // all bytes of this item were
  Forbidden,  // a request upstream that the ICD forbids, or a violated limit of the box; the text explains it
  Replied,    // Adit has read the last byte of an answer with that status
  Opens,      // a connection upstream is open
  Closes,     // Adit closes a connection upstream; requests in flight there have failed
  Taken,      // the Command Post has recorded a report, or accepted a message
  Begins,     // a process of aditd begins
  Stops,      // SIGTERM
  Dies,       // SIGKILL, or the power is cut
  PowerCut,   // follows Dies
  Fails,      // a process could not start
  Ended,      // the process is over
  Saved,      // settings were saved
  Another,    // another sender's report was recorded
  NewRun,
  Fault,
  Written,   // a settings file was put in place; `who` is its digest
  Serves,    // a process begins with those settings
  Mended,    // a fault of the disk has ended
  Copied,    // a copy of the ledger's directory was made
  PutBack,   // that copy replaced the directory, while no process runs; the serial is 1 if it lacks records
  Slow,      // the process stands still for its disk, for `stamp` seconds
  Calm,      // all faults have ended
  Told,      // a message to systemd: "READY", "STATUS", "STOPPING", "WATCHDOG"
  ClockSet,  // the box's clock was set to `stamp` seconds ahead of the world's
  Shows,     // the panel's lights: "1000" in `who` is health alone
  Given,     // a connection is given so many bytes a second (as a serial); its line has as many as the stamp
             // says, 0: more than Adit may use
  Said       // a line of the log
};

/// Numbers in a message beside its serial, see messages.hpp.
using Says = std::vector<int>;

struct Event {
  double at = 0;  // seconds since the run began
  int process = 0;
  Actor actor = Actor::Adit;
  Kind kind = Kind::Said;
  std::string what;         // a path such as "/state/update", or a client's
  std::string who;          // a robot
  std::int64_t serial = 0;  // 0: none
  int status = 0;           // of Invoke: the expected status for a bad message
  double stamp = 0;  // of a message upstream; of an answer: its Retry-After; of a recorded report: its points
  std::string text = {};      // for the log; of an answer to a status its body, of "STATUS" the line
  std::uint64_t request = 0;  // a client's request; upstream: the connection
  Says says = {};
};

/// Event::what of Forbidden for a socket, or for a limit that was exceeded.
inline constexpr const char *kConnect = "connect", *kListen = "listen", *kTooMuch = "too much";
/// Event::what of Opens and Closes.
inline constexpr const char* kConnection = "a connection";
/// Event::status of Leaves.
inline constexpr int kWithSlash = 1;
/// Event::status of Stalls.
inline constexpr int kInHead = 1, kInBody = 2;

/// Which events of a run are printed as they happen.
enum class Telling : std::uint8_t {
  Nothing,
  Story,  // all but what is of every run: the status that is asked for over and over, what the log says of no
          // trouble
  All
};

/// All events of a run, in order.
class History {
 public:
  void note(Event event);
  const std::vector<Event>& events() const { return events_; }
  /// Hash of all events without their texts.
  std::uint64_t hash() const { return hash_; }
  std::size_t faults() const { return faults_; }
  Telling tells = Telling::Nothing;

 private:
  std::vector<Event> events_;
  std::uint64_t hash_ = 0xCBF29CE484222325u;
  std::size_t faults_ = 0;
};

/// One line: the time, and the event in the column of its actor.
std::string line_of(const Event& event);

}  // namespace adit::simulation
