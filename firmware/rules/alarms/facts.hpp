#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "alarms/arrival.hpp"

namespace adit::alarms {

/// Fault of an endpoint or of the way to it, the worst first.
enum class EndpointTrouble : std::uint8_t {
  NoToken,      // no token is set; Adit does not connect
  Unreachable,  // no connection
  Foreign,      // another kind of server answers
  Refusing,     // 401 or 403
  Silent,       // accepts data and does not answer
  Failing,      // answers every request with 5xx or the like
  Throttling,   // repeated 429
  None,
};

struct Endpoint {
  std::string name = {};  // "scoring"
  std::string address = {};
  EndpointTrouble trouble = EndpointTrouble::None;
  double since = 0;                     // start of the trouble, as Facts::now
  std::string said = {};                // detail from the connection or the Command Post
  std::optional<double> well_for = {};  // seconds since the endpoint accepts again; nullopt: it has not been
                                        // stopped
};

/// A report that needs the operator's attention.
struct ReportFact {
  enum class Is : std::uint8_t { Held, InDoubt, Lost };
  std::int64_t number = 0;
  Is is = Is::Held;
  bool asking = false;  // in doubt, and Adit is still finding out
  bool of_run = true;   // of the present run
  std::string note = {};
  double since = 0;
};

/// A cable at an interface.
struct Cable {
  bool is_team = false;
  std::string interface = {};
  std::optional<bool> carrier = {};  // nullopt: no such interface
};

/// A robot's habit and its present silence.
struct Robot {
  double gap = 0;    // usual seconds between two messages
  double quiet = 0;  // seconds since the last one
  bool silent = false;
};

struct CrowdFact {
  enum class Is : std::uint8_t { NoRoom, WrongToken, Unauthenticated };
  Is is = Is::NoRoom;
  std::string address = {};  // of most of these clients
};

/// An address conflict.
struct AddressConflict {
  bool is_team = false;
  std::string interface = {}, address = {};
  std::string mac = {};  // of the other machine
};

/// An address of the Command Post that answers at the team's port instead of its own.
struct SwappedAddress {
  std::string address = {};
  std::string found_on = {}, sought_on = {};  // interfaces
};

struct NetworkFact {
  std::optional<double> confirm_within = {};  // seconds left to confirm a change
  std::string page = {};                      // address for the confirmation
  bool no_address = false;                    // on the Command Post's side
  std::vector<AddressConflict> taken = {};    // at most one for each side
  std::optional<SwappedAddress> exchanged = {};
};

struct Disk {
  std::string run = {};                    // why the display data of the run is not stored, or ""
  std::string map = {}, state = {};        // why the last map, or states and markers, cannot be stored, or ""
  std::optional<std::uint64_t> free = {};  // bytes of the state directory
  unsigned life = 0, spares = 0;           // the wear that its disk reports (host::Wear)
  std::string wear_unknown = {};           // why the wear cannot be read, or ""
};

struct UpdateFact {
  bool on_trial = false;
  std::string version = {};  // of the slot on trial
  std::string stray = {};    // why an unexpected slot runs, with its name, or ""
};

/// Input of the alarm rules at one time.
struct Facts {
  double now = 0;  // seconds since 1970; Board::move() reports clock steps
  std::vector<Endpoint> endpoints = {};
  std::vector<Cable> cables = {};
  NetworkFact network = {};

  std::map<std::string, Robot> robots = {};  // by name
  std::vector<Stream> streams = {};
  double turn = 0;  // seconds in which each queued map has its turn
  std::vector<std::string> unknown_robots = {}, known_robots = {};
  std::vector<CrowdFact> crowds = {};
  bool shut_out = false;  // a token is required, but none is set

  std::size_t queued = 0, queue_room = 0;  // bytes
  bool queue_grows = false;

  std::vector<ReportFact> reports = {};
  std::map<std::string, std::size_t> reports_elsewhere = {};  // by the Command Post they are queued for
  std::optional<std::int64_t> reports_left = {};
  std::string run_unreliable = {};       // why the run's count of reports proves nothing, or ""
  std::string run_renamed = {};          // why the names in answers do not show the run, or ""
  std::size_t messages_rejected = 0;     // stored and not replaced
  std::uint64_t newest_rejected = 0;     // number of the newest; numbers rise
  std::string newest_rejected_why = {};  // "ugv1's cloud: ..."

  std::string ledger_refusal = {}, ledger_damage = {};
  std::string other_ledger = {};  // file of a ledger of another format, or ""
  std::string put_aside = {};     // which queued messages are set aside, and why; or ""
  bool ledger_is_closed = false;  // the ledger cannot be read
  Disk disk = {};
  std::optional<bool> time_set = {};                // nullopt: unknown
  double stamps_ahead = 0;                          // seconds beyond a known time of day; 0: less than a day
  std::string stamps_damage = {};                   // why stamps may have gone back, or ""
  std::string ntp_trouble = {};                     // why NTP does not follow the settings, or ""
  std::string change_trouble = {};                  // of the last change of the settings
  std::string settings_trouble = {};                // why the stored settings are not used
  std::string board_trouble = {};                   // why the board's file is not used
  std::string lights_trouble = {};                  // why the panel may be wrong, or ""
  std::map<std::string, std::string> notices = {};  // of root programs, by name
  UpdateFact update = {};
  std::string standby = {};  // why the box is a standby, or ""
};

}  // namespace adit::alarms
