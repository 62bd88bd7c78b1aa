#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

/// It was not taken, and the same again will not be either.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// It may have been recorded: a person decides what to do.
struct Unknown : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A client that asks until it knows: right with Adit, and, told that it is `bare`, with a Command Post that
/// no Adit stands before.
class Client {
 public:
  Client(std::string url, std::string token, bool bare);

  nlohmann::json status();
  /// The Command Post's answer.
  nlohmann::json report(double x, double y, double z, const std::string& type);
  /// Sends a map, a state or markers, as CBOR: update("map", ...).
  nlohmann::json update(const std::string& what, const nlohmann::json& message);

 private:
  struct Request {
    std::string uri, body, type;  // no body: a GET
  };
  struct Answer {
    long status = 0;  // 0: lost
    bool never_left = false;
    std::string body = {};
    long again_after = 1;  // seconds
  };

  nlohmann::json until_answered(const Request& request);
  Answer ask(const Request& request);

  const std::string url_, token_;
  const bool bare_;
  std::chrono::steady_clock::time_point turn_{};
};
