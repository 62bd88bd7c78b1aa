#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/run_view.hpp"
#include "codec/row.hpp"

namespace adit::api {

using LogFields = std::vector<std::pair<std::string, std::string>>;

/// A record of the log. All text is visible ASCII; other bytes are escaped.
struct LogRecord {
  std::uint64_t seq = 0;
  Time at = 0;
  int severity = 6;   // syslog's (RFC 5424): 0 is the worst
  std::string level;  // its name
  std::string message;
  LogFields fields;
  std::string line;  // all of it, as the log has it

  static const codec::Row kRow;
};

struct LogPage {
  std::uint64_t last = 0;  // the number of the last record there was, whether or not it is among them
  std::vector<LogRecord> records;

  static const codec::Row kRow;
};

/// What was refused to the team, counted since the start.
struct RefusedCount {
  std::string uri;
  int status = 0;
  std::uint64_t count = 0;  // messages
  std::uint64_t parts = 0;  // of states and markers: poses and markers
};

/// Connections of the team that Adit ended, counted since the start.
struct EndedCount {
  std::string why;
  std::uint64_t count = 0;
};

/// What the process has used since its start.
struct Usage {
  Time started = 0;
  double cpu_seconds = 0;
  std::uint64_t resident_bytes = 0, open_files = 0, most_files = 0, threads = 0;
  std::uint64_t connections = 0;       // of the team's side, now
  std::uint64_t unauthenticated = 0;   // those of them that have shown no token
  std::vector<EndedCount> ended = {};  // connections
  std::uint64_t wrong_tokens = 0;      // requests
  std::uint64_t sent_bytes = 0;        // of bodies, to both endpoints
  std::uint64_t rejected_dropped = 0;  // rejected messages, dropped for newer ones
  std::uint64_t exceptions = 0;        // that were caught at the program's edge: loop/guard.hpp
  std::vector<RefusedCount> refused;
};

/// A library that is in the program.
struct PartRow {
  std::string name, version, licence;

  static const codec::Row kRow;
};

/// Which board it is, by the board's file.
struct BoardRow {
  std::string name, title;

  static const codec::Row kRow;
};

struct About {
  std::string version, build;  // build: "9f1c2ab0d3e4, Clang 19.1.4, Release"
  std::string licence;         // of Adit itself
  Time started = 0;
  double uptime = 0;
  std::string kernel, model;
  std::optional<BoardRow> board = std::nullopt;  // nothing: it was not told
  std::vector<PartRow> parts = {};

  static const codec::Row kRow;
};

struct InterfaceRow {
  std::string name;
  bool up = false;
  std::optional<bool> carrier;
  std::vector<std::string> addresses;  // "10.0.0.1/24"

  static const codec::Row kRow;
};

struct RouteRow {
  std::string destination, gateway, interface;  // gateway "": on the link
  unsigned metric = 0;

  static const codec::Row kRow;
};

struct NetworkState {
  std::vector<InterfaceRow> interfaces;
  std::vector<RouteRow> routes;
  std::string trouble;  // why the interfaces cannot be told, or ""

  static const codec::Row kRow;
};

/// The box and its service, as the page shows them.
class Box {
 public:
  virtual ~Box() = default;
  /// The records after that number that are still kept, oldest first, without tokens.
  virtual std::vector<LogRecord> log(std::uint64_t after) const = 0;
  /// The number of the last record there was.
  virtual std::uint64_t logged() const = 0;
  virtual Usage usage() const = 0;
  virtual About about() const = 0;
  virtual NetworkState network() const = 0;
  /// The settings that it runs with: JSON without a token.
  virtual std::string settings() const = 0;
  /// Runs `work`, which takes long, beside the loop, then `done` on it.
  virtual void work(std::function<void()> work, std::function<void()> done) = 0;
};

}  // namespace adit::api
