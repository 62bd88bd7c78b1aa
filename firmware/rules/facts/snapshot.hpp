#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "facts/rows.hpp"
#include "icd/natural_order.hpp"

namespace adit::facts {

/// A robot's habit and its present silence.
struct RobotHabit {
  double gap = 0;    // usual seconds between two messages
  double quiet = 0;  // seconds since the last one
  bool silent = false;
};

using Habits = std::map<std::string, RobotHabit, icd::NaturalOrder>;  // by robot

/// The data between the robots and the Command Post, and the way that they take.
struct Traffic {
  Time now = 0;  // alarms::Board::move() reports clock steps
  std::vector<EndpointRow> endpoints = {};
  std::vector<LinkRow> links = {};  // the interfaces of the settings
  std::vector<ActivityRow> activities = {};
  Habits habits = {};
  std::vector<RobotRow> robots = {};
  std::vector<StandingRow> standings = {};   // from alarms::add_words()
  std::vector<std::string> registered = {};  // the robots of the settings
  double turn = 0;                           // seconds in which each queued map has its turn
  std::size_t queued = 0, queue_room = 0;    // bytes
  bool queue_grows = false;
};

/// Clients that Adit rejects.
struct Crowd {
  enum class Kind : std::uint8_t { NoRoom, WrongToken, NoToken, Unauthenticated };
  Kind kind = Kind::NoRoom;
  std::string address = {};  // of most of these clients
};

struct Clients {
  std::vector<std::string> unknown_robots = {};
  std::vector<Crowd> crowds = {};
  bool shut_out = false;  // a token is required, but none is set
};

/// Reports and rejected messages.
struct Reports {
  std::vector<ReportRow> rows = {};       // newest first: all open reports, and the newest of the others
  std::set<std::int64_t> lost_here = {};  // numbers; new reports are held until the operator settles these
  std::map<std::string, std::size_t> elsewhere = {};  // by the Command Post they are queued for
  std::optional<std::int64_t> left = {};
  std::string run_unreliable = {};  // why the run's count of reports proves nothing, or ""
  std::string run_renamed = {};     // why the names in answers do not show the run, or ""
  std::vector<RejectedRow> rejected = {};
};

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

struct Network {
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

struct Update {
  bool on_trial = false;
  std::string version = {};  // of the slot on trial
  std::string stray = {};    // why an unexpected slot runs, with its name, or ""
};

struct Box {
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
  Update update = {};
  std::string standby = {};  // why the box is a standby, or ""
};

/// The gateway's state at one time: the alarms judge it, and page, `adit`, metrics and lights show it.
struct Snapshot {
  Traffic traffic = {};
  Clients clients = {};
  Reports reports = {};
  Network network = {};
  Box box = {};
};

}  // namespace adit::facts
