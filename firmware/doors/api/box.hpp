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

/// A log record. All text is visible ASCII; other bytes are escaped.
struct LogRecord {
  std::uint64_t seq = 0;
  Time at = 0;
  int severity = 6;   // syslog's number (RFC 5424); 0 is the worst
  std::string level;  // name of the severity
  std::string message;
  LogFields fields;
  std::string line;  // the whole line of the log

  static const codec::Row kRow;
};

struct LogPage {
  std::uint64_t last = 0;  // number of the newest record, even if not included
  std::vector<LogRecord> records;

  static const codec::Row kRow;
};

/// Count of refusals to the team since the start.
struct RefusedCount {
  std::string uri;
  int status = 0;
  std::uint64_t count = 0;  // messages
  std::uint64_t parts = 0;  // poses and markers in these messages
};

/// Count of the team's connections that Adit closed since the start.
struct EndedCount {
  std::string why;
  std::uint64_t count = 0;
};

/// Resources of the process since its start.
struct Usage {
  Time started = 0;
  double cpu_seconds = 0;
  std::uint64_t resident_bytes = 0, open_files = 0, most_files = 0, threads = 0;
  std::uint64_t connections = 0;       // present ones on the team's side
  std::uint64_t unauthenticated = 0;   // of these, without a token
  std::vector<EndedCount> ended = {};  // connections
  std::uint64_t wrong_tokens = 0;      // requests
  std::uint64_t sent_bytes = 0;        // of bodies, to both endpoints
  std::uint64_t rejected_dropped = 0;  // rejected messages, dropped for newer ones
  std::uint64_t exceptions = 0;        // caught at the program's edge: loop/guard.hpp
  std::vector<RefusedCount> refused;
};

/// A library in the program.
struct PartRow {
  std::string name, version, licence;

  static const codec::Row kRow;
};

/// The board, from its file.
struct BoardRow {
  std::string name, title;

  static const codec::Row kRow;
};

struct About {
  std::string version, build;  // build: "9f1c2ab0d3e4, Clang 19.1.4, Release"
  std::string licence;         // of Adit
  Time started = 0;
  double uptime = 0;
  std::string kernel, model;
  std::optional<BoardRow> board = std::nullopt;  // nullopt: unknown
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
  std::string trouble;  // why the interfaces cannot be read, or ""

  static const codec::Row kRow;
};

/// The box and its service, for the page.
class Box {
 public:
  virtual ~Box() = default;
  /// The stored records with a larger number, oldest first, without tokens.
  virtual std::vector<LogRecord> log(std::uint64_t after) const = 0;
  virtual std::uint64_t last_record_number() const = 0;
  virtual Usage usage() const = 0;
  virtual About about() const = 0;
  virtual NetworkState network() const = 0;
  /// The settings in use as JSON, without tokens.
  virtual std::string settings() const = 0;
  /// Runs long `work` on another thread, then `done` on the loop.
  virtual void work(std::function<void()> work, std::function<void()> done) = 0;
};

}  // namespace adit::api
