// Memory that runs out while an answer is taken: that answer is lost, and nothing else.
#include <semaphore>

#include "asking.hpp"
#include "loop/guard.hpp"
#include "scarce_memory.hpp"

namespace adit::uplink {
namespace {

/// A Command Post that answers each request alike, once the test lets it.
class NoMemory : public Asking, public testing::WithParamInterface<std::string> {
 protected:
  static void answer_when_let(Wire& wire, std::counting_semaphore<>& let, const std::string& bytes) {
    for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      let.acquire();
      if (!wire.write(bytes)) return;
    }
  }

  /// What becomes of a request whose answer comes while memory is scarce.
  Outcome ask_scarcely(Connection& connection, std::size_t first, std::size_t count) {
    std::optional<Outcome> outcome;
    connection.send(get(), [&](Outcome got) { outcome = std::move(got); });
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return connection.sent_bytes() > 0; }));
    let_.release();
    const std::uint64_t before = loop::caught_so_far();
    ScarceMemory scarce(first, count);
    while (!outcome && ScarceMemory::failed() == 0) loop_.turn(std::chrono::milliseconds(5));
    failed_ = scarce.end();
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return outcome.has_value(); }));
    caught_ = loop::caught_so_far() - before;
    EXPECT_FALSE(connection.busy());
    return outcome.value_or(NeverSent{"there was none"});
  }

  std::counting_semaphore<> let_{0};
  std::size_t failed_ = 0;
  std::uint64_t caught_ = 0;
};

TEST_P(NoMemory, OfAnAnswerLosesThatAnswerAloneAndIsCountedOnce) {
  ListeningPeer peer([&](Wire& wire) { answer_when_let(wire, let_, GetParam()); });
  Connection connection(loop_, peer.endpoint(), token());
  for (std::size_t n = 0;; ++n) {
    SCOPED_TRACE(n);
    const Outcome outcome = ask_scarcely(connection, n, 1);
    EXPECT_EQ(caught_, failed_);
    if (failed_ == 0) {
      EXPECT_EQ(answered(outcome).status, 200);
      EXPECT_GT(n, 2u) << "hardly any of it was tried";
      return;
    }
    EXPECT_TRUE(std::holds_alternative<InDoubt>(outcome)) << why(outcome);
    EXPECT_NE(why(outcome), "");
    let_.release();
    EXPECT_EQ(answered(ask(connection, get())).status, 200) << "the next one finds all well";
  }
}

/// The worst of it: nothing at all can be had until the answer is dealt with.
TEST_P(NoMemory, AtAllLosesThatAnswerAloneToo) {
  ListeningPeer peer([&](Wire& wire) { answer_when_let(wire, let_, GetParam()); });
  Connection connection(loop_, peer.endpoint(), token());
  for (std::size_t n = 0;; ++n) {
    SCOPED_TRACE(n);
    const Outcome outcome = ask_scarcely(connection, n, ScarceMemory::kAll);
    if (failed_ == 0) return;
    EXPECT_GE(caught_, 1u);
    ASSERT_TRUE(std::holds_alternative<InDoubt>(outcome)) << why(outcome);
    ASSERT_EQ(why(outcome).find("silent"), std::string::npos) << "it waited for what had come";
    let_.release();
    EXPECT_EQ(answered(ask(connection, get())).status, 200) << "the next one finds all well";
  }
}

INSTANTIATE_TEST_SUITE_P(
    WhateverTheAnswer, NoMemory,
    testing::Values(answer("200 OK", R"({"score": 1, "remaining_reports": 19, "run_clock": 12.5})"),
                    answer("200 OK", std::string(20'000, ' ') + "null",
                           "Retry-After: 1\r\nContent-Type: application/json\r\n"),
                    "HTTP/1.1 100 Continue\r\n\r\n" + answer("200 OK", "null"),
                    "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n4\r\nnull\r\n0\r\n\r\n"));

TEST_F(Asking, NoMemoryWithinSendingIsToldToo) {
  Endpoint nowhere{.address = "127.0.0.1", .port = 1, .interface = "no-such-one"};  // known at once
  Connection connection(loop_, nowhere, token());
  for (std::size_t n = 0;; ++n) {
    SCOPED_TRACE(n);
    Request request = get();
    bool sent = false, told = false;
    std::function<void(Outcome)> done = [&](const Outcome&) { told = true; };
    ScarceMemory scarce(n, 1);
    const bool taken =
        loop::guarded("a test", [&] { connection.send(std::move(request), std::move(done)), sent = true; });
    const std::size_t failed = scarce.end();
    EXPECT_EQ(taken, sent);
    if (sent) {
      EXPECT_TRUE(loop::turn_until(loop_, [&] { return told; }));
    }
    ASSERT_FALSE(connection.busy()) << "for ever";
    if (failed == 0) return;
  }
}

}  // namespace
}  // namespace adit::uplink
