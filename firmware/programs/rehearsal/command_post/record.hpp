#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
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

  OrderedJson counts() const;
  void note_part(const std::string& uri, const Accepted& part);

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

}  // namespace adit::rehearsal
