// The rules of token_guesses_test.cpp at a real server.
#include "intake/turnstile.hpp"

#include <gtest/gtest.h>

#include "intake/raw_client.hpp"
#include "intake/scripted_handler.hpp"
#include "intake/served.hpp"
#include "loop/simulated_time.hpp"

namespace adit::intake {
namespace {

using namespace std::chrono_literals;

constexpr std::string_view kRight = "Authorization: Bearer x\r\n";

class TurnstileTest : public testing::Test {
 protected:
  TurnstileTest() { handler_.asks_token = true; }

  std::optional<Reply> ask(const std::string& path, std::string_view headers, const std::string& source,
                           std::string_view body = "1") {
    RawClient client(served_.port(), source);
    client.send(request("POST", path, headers, body));
    served_.turn_often();
    time_.pass(50ms);
    served_.turn_often();
    return client.reply();
  }
  std::optional<Reply> guess(const std::string& source, std::string_view body = "1") {
    return ask("/refuse", "Authorization: Bearer wrong" + std::to_string(++guessed_) + "\r\n", source, body);
  }
  int status_of(const std::optional<Reply>& reply) { return reply ? reply->status : 0; }

  loop::SimulatedTime time_;
  ScriptedHandler handler_;
  Served served_{handler_, {.address = "127.0.0.1", .interface = {}, .late = 50ms}};
  int guessed_ = 0;
};

TEST_F(TurnstileTest, ChecksAFewTokensAtOnceAndNoMore) {
  for (int i = 0; i < TokenGuesses::kFree; ++i) ASSERT_EQ(status_of(guess("127.0.1.1")), 401) << i;
  std::optional<Reply> reply;
  for (int i = 0; i < 1000 && status_of(reply) != 429; ++i) reply = guess("127.0.1.1");
  ASSERT_EQ(status_of(reply), 429);
  EXPECT_EQ(reply->header("retry-after"), "1");
  EXPECT_EQ(status_of(ask("/echo", kRight, "127.0.1.2")), 200);
  EXPECT_GT(served_.ended(CloseReason::WrongToken), static_cast<unsigned>(TokenGuesses::kFree));
}

TEST_F(TurnstileTest, AdmitsAnAuthenticatedAddressAtOnce) {
  ASSERT_EQ(status_of(ask("/echo", kRight, "127.0.1.1")), 200);
  for (int i = 0; i < 30; ++i) {
    guess("127.0.1.1");
    ASSERT_EQ(status_of(ask("/echo", kRight, "127.0.1.1")), 200) << i;
  }
}

TEST_F(TurnstileTest, ReadsNoBodyIfItsAnswerIsDelayed) {
  const std::string large(3u << 20, 'x');
  for (int i = 0; i < TokenGuesses::kFree; ++i) guess("127.0.1.1");
  for (int i = 0; i < 20; ++i) {
    const auto reply = guess("127.0.1.1", large);
    ASSERT_TRUE(status_of(reply) == 429 || status_of(reply) == 401) << i;
  }
  EXPECT_EQ(handler_.body_bytes, 0u);
}

/// A library that writes all before it reads gets a broken pipe if the server closes earlier.
TEST_F(TurnstileTest, ReadsAMapToItsEndSoThatItsSenderLearnsWhy) {
  const std::string map(5'000'000, 'x');
  for (const char* framing :
       {"Content-Length: 5000000\r\n\r\n", "Transfer-Encoding: chunked\r\n\r\n4c4b40\r\n"}) {
    RawClient client(served_.port(), "127.0.1.3");
    ASSERT_TRUE(client.send("POST /refuse HTTP/1.1\r\nHost: adit.local\r\nAuthorization: Bearer wrong\r\n"));
    EXPECT_TRUE(client.send(framing + map)) << framing;
    EXPECT_EQ(status_of(client.reply()), 401) << framing;
  }
  RawClient endless(served_.port(), "127.0.1.3");
  endless.send(
      "POST /refuse HTTP/1.1\r\nHost: adit.local\r\nAuthorization: Bearer wrong\r\n"
      "Content-Length: 100000000\r\n\r\n");
  EXPECT_FALSE(endless.send(std::string(20'000'000, 'x'))) << "at most 8.4 MB are read";
}

TEST_F(TurnstileTest, KeepsNothingOfDisconnectedClients) {
  for (int i = 0; i < 50; ++i) {
    RawClient client(served_.port(), "127.0.1.1");
    client.send(request("POST", "/refuse", "Authorization: Bearer wrong\r\n", "1"));
  }
  EXPECT_TRUE(served_.eventually([&] {
    time_.pass(50ms);
    return served_.server().connections() == 0;
  }));
}

}  // namespace
}  // namespace adit::intake
