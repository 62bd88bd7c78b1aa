#pragma once

#include <cstdint>
#include <deque>
#include <expected>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "rehearsal/command_post/document.hpp"
#include "rehearsal/command_post/endpoint.hpp"
#include "rehearsal/command_post/messages.hpp"
#include "rehearsal/command_post/run.hpp"

namespace adit::rehearsal {

/// Who sent a report: the "by" of each in the record.
inline constexpr const char* kByClient = "client";
inline constexpr const char* kByOther = "other sender";

/// What a run came to: counts, reports, violations of the ICD. Bounded, whatever a peer sends. Safe for use
/// by several threads.
class Record {
 public:
  explicit Record(Manner manner) : manner_(manner) {}

  void note(std::uint64_t number, const Judgement& judgement);

  /// A report that was recorded, whoever sent it. They are kept in the order of their ids.
  void note_report(const OrderedJson& report);

  /// Why the measured mapping server died, or "".
  std::string killed_by() const;

  /// The record as GET /record gives it.
  OrderedJson json(const Run::Standing& standing) const;

  /// The same for a person to read.
  std::string summary(const Run::Standing& standing) const;

 private:
  using UriAndStatus = std::pair<std::string, int>;  // status 0: not answered
  using UriAndFault = std::pair<std::string, std::string>;
  using Part = std::tuple<std::string, std::string, std::string>;  // uri, kind, robot

  struct Violation {
    std::uint64_t number = 0;
    std::string uri;
    std::string sentence;
  };

  const Manner manner_;
  mutable std::mutex mutex_;
  std::map<UriAndStatus, std::uint64_t> requests_;
  std::map<Part, std::uint64_t> accepted_;
  std::map<UriAndFault, std::uint64_t> faults_;
  std::deque<OrderedJson> reports_;
  std::uint64_t report_count_ = 0;
  std::vector<Violation> violations_;
  std::uint64_t violation_count_ = 0;
  std::string killed_by_;
};

/// A folder that a person can look through: requests.jsonl and reports.jsonl, one line each; grids/ and
/// clouds/ with a picture of each map. Safe for use by several threads.
class Transcript {
 public:
  /// Makes `folder`; lines go after those that a transcript there already has. Once `most` bytes are written
  /// there are no more pictures, only lines.
  static std::expected<std::unique_ptr<Transcript>, std::string> open(const std::string& folder,
                                                                      std::uint64_t most);

  /// How many requests are written down.
  std::uint64_t requests() const { return requests_; }

  /// Writes a request, and the picture of its map. Shortens `judgement.message`.
  void request(std::uint64_t number, const char* endpoint, const Request& request, Judgement& judgement);
  void report(const OrderedJson& line) { append(reports_file_, line); }

 private:
  Transcript(std::string folder, std::uint64_t most) : folder_(std::move(folder)), most_(most) {}
  /// Writes a map's picture, and returns its name within the folder ("grids/000012-X1.pgm"). std::nullopt if
  /// the budget is used up or the disk is full.
  std::optional<std::string> picture(std::uint64_t number, const MapMessage& map);
  void append(std::ofstream& file, const OrderedJson& line);

  const Clock::time_point opened_ = Clock::now();
  const std::string folder_;
  const std::uint64_t most_;
  std::uint64_t requests_ = 0;
  std::mutex mutex_;
  std::uint64_t written_ = 0;
  bool complained_ = false;
  std::ofstream requests_file_;
  std::ofstream reports_file_;
};

}  // namespace adit::rehearsal
