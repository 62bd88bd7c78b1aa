#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "codec/row.hpp"
#include "icd/bearer_token.hpp"
#include "icd/status.hpp"

namespace adit::api {

/// One step of the Test for one endpoint.
struct TestStep {
  std::string name;
  std::string state = "waiting";
  std::string said;    // result
  std::string advice;  // what to do, or ""

  static const codec::Row kRow;
};

struct TestedEndpoint {
  std::string name;     // "scoring", "mapping"
  std::string address;  // "10.100.1.200:8000"
  std::vector<TestStep> steps;

  static const codec::Row kRow;
};

struct TestView {
  std::uint64_t number = 0;  // number of tests since aditd started
  bool running = false;
  bool applied = true;                    // tests the settings in use; otherwise named values
  bool outdated = false;                  // settings or tokens have changed since the start of the test
  std::string course;                     // source of addresses and tokens that were not named; "": no course
  std::vector<TestedEndpoint> endpoints;  // of the present or last test; empty before the first

  static const codec::Row kRow;
};

/// Values to test instead of those in use. They are not stored.
struct Candidate {
  struct Endpoint {
    std::optional<std::string> address;  // nullopt: the course's
    std::optional<std::uint16_t> port;
    std::optional<icd::BearerToken> token;
  };
  std::optional<std::string> course;         // nullopt: the one in use; "": none
  std::optional<Endpoint> scoring, mapping;  // if only one is named, only that one is tested

  bool is_applied() const { return !course && !scoring && !mapping; }
};

/// Reads `{"course": "B", "scoring": {"address", "port", "token"}, "mapping": {...}}`; all members optional.
icd::Checked<Candidate> read_candidate(const std::string& body);

/// Tests each endpoint step by step, without spending a report.
class SelfTest {
 public:
  virtual ~SelfTest() = default;
  virtual TestView state() const = 0;
  /// Error 409: a test is running; watch its result. 422: an impossible endpoint.
  virtual icd::Checked<void> begin_test(const Candidate& candidate) = 0;
};

}  // namespace adit::api
