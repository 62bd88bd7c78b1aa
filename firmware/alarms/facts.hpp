#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "alarms/arrival.hpp"

namespace adit::alarms {

/// What is wrong with an endpoint of the Command Post, or with the way to it; the worst first.
enum class PostTrouble : std::uint8_t {
  NoToken,      // none is set: it is not asked
  Unreachable,  // no connection
  Foreign,      // what answers there is no Command Post
  Refusing,     // 401 or 403
  Silent,       // it takes what is sent and answers nothing
  Failing,      // it answers everything with 5xx or the like
  Throttling,   // 429, again and again
  None,
};

struct Endpoint {
  std::string name = {};  // "scoring"
  std::string address = {};
  PostTrouble trouble = PostTrouble::None;
  double since = 0;                     // of the trouble, as Facts::now
  std::string said = {};                // about the trouble: what the connection, or the Command Post, says
  std::optional<double> well_for = {};  // seconds since it takes again what it could not; nothing: none such
};

/// A report that the operator has to know of.
struct ReportFact {
  enum class Is : std::uint8_t { Held, InDoubt, Lost };
  std::int64_t number = 0;
  Is is = Is::Held;
  bool asking = false;  // in doubt, and Adit is finding out
  bool of_run = true;   // of the present one
  std::string note = {};
  double since = 0;
};

/// A cable, by its interface.
struct Cable {
  bool is_team = false;
  std::string interface = {};
  std::optional<bool> carrier = {};  // nothing: there is no such interface
};

/// A robot's habit, and how long it has said nothing.
struct Robot {
  double gap = 0;    // seconds, as a rule, between two messages
  double quiet = 0;  // seconds since the last one
  bool silent = false;
};

struct Crowd {
  enum class Is : std::uint8_t { NoRoom, WrongToken, Strangers };
  Is is = Is::NoRoom;
  std::string address = {};  // of most of them
};

/// An address of the box's that another machine uses, too.
struct TakenAddress {
  bool is_team = false;
  std::string interface = {}, address = {};
  std::string mac = {};  // of the other machine
};

/// An address of the Command Post's that is at the team's port, and not at its own.
struct ExchangedAddress {
  std::string address = {};
  std::string found_on = {}, sought_on = {};  // the interfaces
};

struct NetworkFact {
  std::optional<double> confirm_within = {};  // seconds; a change waits to be confirmed
  std::string page = {};                      // where
  bool no_address = false;                    // on the Command Post's side
  std::vector<TakenAddress> taken = {};       // one of a side
  std::optional<ExchangedAddress> exchanged = {};
};

struct Disk {
  std::string run = {};                    // why what is shown of the run is not kept; or ""
  std::string map = {}, state = {};        // why the last map, or states and markers, cannot be kept; or ""
  std::optional<std::uint64_t> free = {};  // bytes, of the state folder
};

struct UpdateFact {
  bool on_trial = false;
  std::string version = {};  // of what is on trial
  std::string stray = {};    // which other slot runs than the one that was good last, and why; or ""
};

/// All that the rules of alarms go by, at one moment.
struct Facts {
  double now = 0;  // seconds since 1970; Board::move() tells where that was set
  std::vector<Endpoint> endpoints = {};
  std::vector<Cable> cables = {};
  NetworkFact network = {};

  std::map<std::string, Robot> robots = {};  // by name
  std::vector<Stream> streams = {};
  double turn = 0;  // seconds within which each map that waits has its turn
  std::vector<std::string> unknown_robots = {}, known_robots = {};
  std::vector<Crowd> crowds = {};
  bool shut_out = false;  // a token is asked for, and none is set

  std::size_t queued = 0, queue_room = 0;  // bytes
  bool queue_grows = false;

  std::vector<ReportFact> reports = {};
  std::map<std::string, std::size_t> reports_elsewhere = {};  // by the Command Post that they wait for
  std::optional<std::int64_t> reports_left = {};
  std::string run_unreliable = {};    // why its count of reports proves nothing; or ""
  std::size_t messages_rejected = 0;  // kept, and not replaced
  std::uint64_t newest_rejected = 0;  // number of the newest of them; later ones have larger numbers

  std::string ledger_refusal = {}, ledger_damage = {};
  std::string put_aside = {};     // a sentence: which queued messages are put aside, and why; or ""
  bool ledger_is_closed = false;  // it cannot be read
  Disk disk = {};
  std::optional<bool> time_set = {};                // nothing: the box cannot tell
  std::string ntp_trouble = {};                     // why NTP is not as the settings have it; or ""
  std::string change_trouble = {};                  // of the last change of the settings
  std::string settings_trouble = {};                // why the saved ones are not used
  std::string board_trouble = {};                   // why the board's file is not
  std::string lights_trouble = {};                  // why the panel may show something else; or ""
  std::map<std::string, std::string> notices = {};  // of root's programs, by their names
  UpdateFact update = {};
  std::string standby = {};  // why the box takes nothing and sends nothing; or ""
};

}  // namespace adit::alarms
