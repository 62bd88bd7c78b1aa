#pragma once

#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/api.hpp"
#include "api/counted_map.hpp"
#include "api/doubles.hpp"
#include "api/fake_box.hpp"
#include "api/fake_certificate.hpp"
#include "api/fake_clock.hpp"
#include "api/fake_kept_runs.hpp"
#include "api/fake_setup.hpp"
#include "api/fake_spare.hpp"
#include "api/fake_updates.hpp"

namespace adit::api {

struct FakeFlow final : intake::FlowControl {
  void resume() override { ++resumed; }
  int resumed = 0;
};

inline const std::vector<intake::Header> kJsonByToken = {kByToken, {"Content-Type", "application/json"}};

/// Everything that an API needs.
struct Doubles {
  ApiServices served() {
    return {.source = source,
            .decisions = decisions,
            .gateway_control = decisions,
            .keys = keys,
            .setup = setup,
            .network = network,
            .test = test,
            .updates = updates,
            .box = box,
            .runs = runs,
            .clock = clock,
            .finer = finer,
            .covered = covered,
            .spare = spare,
            .certificate = certificate};
  }

  FakeSource source;
  FakeOperator decisions;
  FakeKeys keys;
  FakeSetup setup;
  FakeNetwork network;
  FakeTest test;
  FakeUpdates updates;
  FakeBox box;
  FakeKeptRuns runs;
  FakeClock clock;
  NoFinerMap finer;
  CountedMap covered{source};
  FakeSpare spare;
  FakeCertificate certificate;
};

/// An API of doubles, called without a server.
struct Page : Doubles {
  /// Begins a request. `responder` gets the answer.
  std::unique_ptr<intake::BodySink> open(const std::string& method, const std::string& target,
                                         std::vector<intake::Header> headers,
                                         std::optional<std::uint64_t> length) {
    auto& head = heads.emplace_back(method, target, std::move(headers), length).from_to(peer, local);
    if (by_tls) head.by_tls();
    responder = std::make_shared<FakeResponder>();
    return api.open(heads.back(), responder, flow);
  }
  static void send(intake::BodySink* sink, const std::string& body) {
    if (sink == nullptr) return;
    if (!body.empty()) sink->on_body({reinterpret_cast<const std::uint8_t*>(body.data()), body.size()});
    sink->on_end();
  }
  /// The answer to a request. The body is passed on if the API reads one.
  intake::Answer request(const std::string& method, const std::string& target,
                         std::vector<intake::Header> headers, const std::string& body = "") {
    const auto sink = open(method, target, std::move(headers), body.size());
    took_body = sink != nullptr;
    send(sink.get(), body);
    EXPECT_TRUE(responder->answered.has_value()) << target;
    return responder->answered.value_or(intake::Answer{});
  }
  intake::Answer get(const std::string& target) { return request("GET", target, {kByToken}); }
  /// The answer to a GET of a file, which never reads the body.
  intake::Answer get_file(const std::string& target, std::string if_none_match = "",
                          const std::string& method = "GET") {
    auto answer = request(method, target, {{"If-None-Match", std::move(if_none_match)}, kByToken});
    EXPECT_FALSE(took_body && !target.starts_with("/adit/")) << target;
    return answer;
  }
  intake::Answer post(const std::string& target, const std::string& body = "{}") {
    return request("POST", target, kJsonByToken, body);
  }

  std::deque<FakeHead> heads;  // must outlive their requests
  std::string peer = "10.0.0.5", local = "10.0.0.1";
  bool by_tls = false;
  bool took_body = false;  // the last request was not answered from its head alone
  std::shared_ptr<FakeResponder> responder;
  std::shared_ptr<FakeFlow> flow = std::make_shared<FakeFlow>();

  loop::Loop loop;
  Api api{loop,
          served(),
          {token("team-1"), token("scoring-1")},
          icd::Redaction({token("team-1"), token("scoring-1")})};
};

class OnPage : public testing::Test, protected Page {};

}  // namespace adit::api
