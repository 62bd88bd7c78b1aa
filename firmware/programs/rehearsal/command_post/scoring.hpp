#pragma once

#include <array>
#include <mutex>
#include <optional>
#include <string>

#include "rehearsal/command_post/gate.hpp"
#include "rehearsal/command_post/judgement.hpp"
#include "rehearsal/command_post/run.hpp"

namespace adit::rehearsal {

/// The scoring endpoint of the ICD's section 5, to the letter. At most `hz` requests a second for each URI,
/// or for both together.
class StrictScoring : public Endpoint {
 public:
  StrictScoring(std::string token, double hz, bool one_limit, Run& run);
  Judgement judge(const Request& request) override;

 private:
  bool too_many(const Request& request);
  void classify_report(const Request& request, Judgement& judgement);

  const std::string token_;
  Run& run_;
  std::mutex mutex_;
  const bool one_limit_;
  RateLimit status_limit_;
  RateLimit report_limit_;  // of statuses too, if there is one limit
};

/// The public test server for scoring, as measured: see each rule in its source.
class MeasuredScoring : public Endpoint {
 public:
  MeasuredScoring(std::string token, double hz, Run& run);
  Judgement judge(const Request& request) override;

 private:
  void judge_known(const Request& request, Judgement& judgement);
  void classify_report(const Request& request, Judgement& judgement);
  bool too_many(const Request& request);

  const std::string token_;
  Run& run_;
  std::mutex mutex_;
  RateLimit limit_;
};

/// The body of GET /api/status (ICD 5.1).
OrderedJson status_body(const Run& run, Clock::time_point now);

/// The body of an answer to POST /api/artifact_reports (ICD 5.2). x, y, z and type are given back as they
/// came; `authority`: the address and port in its url.
OrderedJson report_body(const Run::Ruling& ruling, const Json& sent, const std::string& authority);

/// Writes down that the report was scored before.
void tell_repeat(const Run::Ruling& ruling, Findings& findings);

/// Where no address is known, or as the measured server has it.
inline constexpr const char* kNoAuthority = "<ipaddress>:<port>";

}  // namespace adit::rehearsal
