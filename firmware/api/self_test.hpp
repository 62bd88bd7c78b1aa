#pragma once

#include <string>
#include <vector>

#include "codec/row.hpp"

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
  bool running = false;
  std::vector<TestedEndpoint> endpoints;  // of the test that runs, or of the last; empty: none so far

  static const codec::Row kRow;
};

/// Tries each endpoint step by step, and never spends a report.
class SelfTest {
 public:
  virtual ~SelfTest() = default;
  virtual TestView test() const = 0;
  /// False where one runs already: that one's result is to be watched.
  virtual bool begin_test() = 0;
};

}  // namespace adit::api
