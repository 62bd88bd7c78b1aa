#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "codec/row.hpp"
#include "icd/bearer_token.hpp"
#include "icd/status.hpp"

namespace adit::api {

/// One question of the Test about one endpoint.
struct TestStep {
  std::string name;
  std::string state = "waiting";
  std::string said;    // what was found
  std::string advice;  // what to do about it; "" where nothing is to be done

  static const codec::Row kRow;
};

struct TestedEndpoint {
  std::string name;     // "scoring", "mapping"
  std::string address;  // "10.100.1.200:8000"
  std::vector<TestStep> steps;

  static const codec::Row kRow;
};

struct TestView {
  std::uint64_t number = 0;  // of tests since aditd started; 0 before the first
  bool running = false;
  bool applied = true;    // the settings in use are tested; false: named values are
  bool outdated = false;  // settings or tokens have changed since the test began
  std::string course;     // whose addresses and tokens count where none were named; "": none's
  std::vector<TestedEndpoint> endpoints;  // of the test that runs, or of the last; empty: none so far

  static const codec::Row kRow;
};

/// What is tried instead of what is in use. Nothing of it is kept.
struct Candidate {
  struct Endpoint {
    std::optional<std::string> address;  // nothing: the course's
    std::optional<std::uint16_t> port;
    std::optional<icd::BearerToken> token;
  };
  std::optional<std::string> course;         // nothing: the one in use; "": none
  std::optional<Endpoint> scoring, mapping;  // where only one is named, only that one is tried

  bool is_applied() const { return !course && !scoring && !mapping; }
};

/// Of `{"course": "B", "scoring": {"address", "port", "token"}, "mapping": {...}}`, of which all may be left
/// out.
icd::Checked<Candidate> read_candidate(const std::string& body);

/// Tries each endpoint step by step, and never spends a report.
class SelfTest {
 public:
  virtual ~SelfTest() = default;
  virtual TestView test() const = 0;
  /// 409 where one runs already: that one's result is to be watched. 422 where there can be no such endpoint.
  virtual icd::Checked<void> begin_test(const Candidate& candidate) = 0;
};

}  // namespace adit::api
