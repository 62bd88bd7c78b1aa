#pragma once

#include <string>
#include <vector>

namespace adit::api {

/// One question of the Test about one endpoint.
struct TestStep {
  std::string name;               // "link", "address", "reach", "token", "clock"
  std::string state = "waiting";  // "running", "good", "bad", "skipped"
  std::string said;               // what was found
  std::string advice;             // what to do about it; "" where nothing is to be done
};

struct TestedEndpoint {
  std::string name;     // "scoring", "mapping"
  std::string address;  // "10.100.1.200:8000"
  std::vector<TestStep> steps;
};

struct TestView {
  bool running = false;
  std::vector<TestedEndpoint> endpoints;  // of the test that runs, or of the last; empty: none so far
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
