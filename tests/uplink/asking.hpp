#pragma once

#include <gmock/gmock.h>

#include <stdexcept>
#include <string>
#include <utility>

#include "loop/simulated_time.hpp"
#include "loop/turn_until.hpp"
#include "patience.hpp"
#include "peer.hpp"
#include "uplink/connection.hpp"

namespace adit::uplink {

inline constexpr const char* kToken = "s3cret-Token.0123456789";

inline icd::BearerToken token() {
  const auto parsed = icd::BearerToken::parse(kToken);
  if (!parsed) throw std::runtime_error("the test's token is none");
  return *parsed;
}

/// The program's clocks stand still, and move only by pass(). A base before Asking, whose loop needs it.
struct StandingTime {
  loop::SimulatedTime time;
};

/// A loop and connections on it.
class Asking : public testing::Test {
 protected:
  static inline const std::chrono::seconds kPatience = patient(std::chrono::seconds{20});

  /// Sends and waits for the outcome. Checks that it never arrives within send() and never contains the
  /// token.
  Outcome ask(Connection& connection, Request request) {
    Outcome outcome;
    bool came = false;
    connection.send(std::move(request), [&](Outcome got) { outcome = std::move(got), came = true; });
    EXPECT_FALSE(came) << "done was called from within send()";
    EXPECT_TRUE(connection.busy());
    if (!loop::turn_until(loop_, [&] { return came; })) throw std::runtime_error("there is no outcome");
    EXPECT_FALSE(connection.busy());
    EXPECT_THAT(why(outcome), testing::Not(testing::HasSubstr(kToken)));
    return outcome;
  }
  Outcome ask(const Endpoint& endpoint, Request request) {
    Connection connection(loop_, endpoint, token());
    return ask(connection, std::move(request));
  }

  static std::string why(const Outcome& outcome) {
    if (const auto* never = std::get_if<NeverSent>(&outcome)) return never->why;
    if (const auto* doubt = std::get_if<InDoubt>(&outcome)) return doubt->why;
    return "";
  }

  /// The outcome as an Answered; for other outcomes status 0 and the sentence as its body.
  static Answered answered(const Outcome& outcome) {
    if (const auto* answer = std::get_if<Answered>(&outcome)) return *answer;
    return {.status = 0, .content_type = "", .body = why(outcome), .retry_after = std::nullopt};
  }

  static Request get(std::string target = "/api/status") {
    Request request;
    request.method = "GET";
    request.target = std::move(target);
    request.answer_within = kPatience;
    return request;
  }
  static Request post(const std::string& body) {
    Request request;
    request.method = "POST";
    request.target = "/map/update";
    request.content_type = "application/cbor";
    request.body.append({reinterpret_cast<const std::uint8_t*>(body.data()), body.size()});
    request.answer_within = kPatience;
    return request;
  }
  static std::string megabytes(std::size_t count) {
    std::string body(count << 20, '\0');
    for (std::size_t i = 0; i < body.size(); ++i) body[i] = static_cast<char>(i * 131 >> 3);
    return body;
  }

  loop::Loop loop_;
};

}  // namespace adit::uplink
