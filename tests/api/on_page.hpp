#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "api/api.hpp"
#include "api/doubles.hpp"

namespace adit::api {

/// A page of doubles, asked without a server.
class OnPage : public testing::Test {
 protected:
  /// The answer to a request; its body is handed over where the page takes one.
  intake::Answer request(const std::string& method, const std::string& target,
                         std::vector<intake::Header> headers, const std::string& body = "") {
    auto responder = std::make_shared<FakeResponder>();
    const auto exchange = api.open(FakeHead{method, target, std::move(headers), body.size()}, responder, {});
    took_body = exchange != nullptr;
    if (exchange) {
      exchange->on_body({reinterpret_cast<const std::uint8_t*>(body.data()), body.size()});
      exchange->on_end();
    }
    EXPECT_TRUE(responder->answered.has_value()) << target;
    return responder->answered.value_or(intake::Answer{});
  }
  bool took_body = false;  // the last request's: it was not answered from its head alone

  loop::Loop loop;
  FakeSource source;
  FakeOperator judge;
  FakeKeys keys;
  Api api{loop, source, judge, keys, {token("team-1")}};
};

}  // namespace adit::api
