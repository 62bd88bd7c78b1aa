#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace adit::simulation {

enum class Actor : std::uint8_t { Team, Adit, Post, Disk };

/// What may happen. Each that has a serial says of which message.
enum class Kind : std::uint8_t {
  Invoke,     // a client begins to ask; one for each thing that its request says
  Whole,      // the last byte of its request is on its way
  Stalls,     // it sends no more of it, and waits
  Answered,   // the client has heard a whole answer, of that status
  Gone,       // the client has not, and the connection is over: it hung up, or was cut
  Leaves,     // the first byte of a request upstream is given to the network
  Complete,   // the last one is
  Left,       // and so the message that it carries
  Forbidden,  // it was one that the ICD forbids, or what must not be in the box; the text says why
  Replied,    // Adit has read the last byte of an answer of that status
  Opens,      // it finds a connection upstream open
  Closes,     // it closes one: what was under way there has failed
  Taken,      // the Command Post has recorded a report, or taken a message
  Begins,     // a life of aditd
  Stops,      // it was told to, by SIGTERM
  Dies,       // by SIGKILL, or as the power is cut
  PowerCut,   // which follows
  Fails,      // a life did not begin
  Ended,      // the process is over
  Saved,      // settings were saved
  Another,    // it has recorded somebody else's report
  NewRun,
  Fault,
  Written,   // settings are put in place; `who` stands for what they say
  Serves,    // a life begins with those
  Mended,    // a fault of the disk is over
  Slow,      // the process stands still for its disk, so many seconds (as a stamp)
  Calm,      // no fault begins any more
  Told,      // to systemd: "READY", "STATUS", "STOPPING", "WATCHDOG"
  ClockSet,  // the box's clock is another from now on, so many seconds ahead of the world's (as a stamp)
  Shows,     // the panel: its lights are lit as `who` says, "1000" for health alone
  Given,     // a connection is given so many bytes a second (as a serial); its line has as many as the stamp
             // says, 0: more than Adit may use
  Said       // a line of the log
};

/// What a message says beside its serial, in numbers: see messages.hpp.
using Says = std::vector<int>;

struct Event {
  double at = 0;  // seconds since the run began
  int life = 0;
  Actor actor = Actor::Adit;
  Kind kind = Kind::Said;
  std::string what;         // a path, as in "/state/update", or a client's
  std::string who;          // a robot
  std::int64_t serial = 0;  // 0: none
  int status = 0;           // of Invoke: that the ICD has for a bad message
  double stamp = 0;  // of a message upstream; of an answer: its Retry-After; of a recorded report: its points
  std::string text = {};      // for the story; of an answer to a status its body, of "STATUS" the line
  std::uint64_t request = 0;  // of a client: which; of one upstream: its connection
  Says says = {};
};

/// Of Forbidden, where it is a socket, or more of something than may be.
inline constexpr const char *kConnect = "connect", *kListen = "listen", *kTooMuch = "too much";
/// Of Opens and Closes.
inline constexpr const char* kConnection = "a connection";
/// Of Stalls, as its status.
inline constexpr int kInHead = 1, kInBody = 2;

/// What of a run is told on standard output, as it happens.
enum class Telling : std::uint8_t {
  Nothing,
  Story,  // all but what is of every run: the status that is asked for over and over, what the log says of no
          // trouble
  All
};

/// All that both sides saw, in order.
class History {
 public:
  void note(Event event);
  const std::vector<Event>& events() const { return events_; }
  /// Of all that the events say but their texts.
  std::uint64_t hash() const { return hash_; }
  std::size_t faults() const { return faults_; }
  Telling tells = Telling::Nothing;

 private:
  std::vector<Event> events_;
  std::uint64_t hash_ = 0xCBF29CE484222325u;
  std::size_t faults_ = 0;
};

/// One line: time, and in the column of its actor what happened.
std::string line_of(const Event& event);

}  // namespace adit::simulation
