// An exception of a handler ends only its request.
#include <gtest/gtest.h>

#include <new>
#include <stdexcept>

#include "intake/raw_client.hpp"
#include "intake/served.hpp"
#include "intake/server.hpp"
#include "loop/guard.hpp"

namespace adit::intake {
namespace {

/// Throws at /open, /body or /end, drops its responder at /drop, and answers any other path.
class ThrowingHandler final : public Handler {
 public:
  Credentials read_credentials(const RequestHead&) override { return Credentials::Enough; }
  std::unique_ptr<BodySink> open(const RequestHead& head, std::shared_ptr<Responder> responder,
                                 std::shared_ptr<FlowControl>) override {
    const std::string path(head.path());
    if (path == "/open") throw std::bad_alloc();
    if (path == "/drop") responder.reset();
    return std::make_unique<Throwing>(path, std::move(responder));
  }

 private:
  class Throwing final : public BodySink {
   public:
    Throwing(std::string path, std::shared_ptr<Responder> responder)
        : path_(std::move(path)), responder_(std::move(responder)) {}
    bool on_body(std::span<const std::uint8_t>) override {
      if (path_ == "/body") throw std::length_error("too long");
      return true;
    }
    void on_end() override {
      if (path_ == "/end") throw std::runtime_error("at the end");
      if (responder_) responder_->answer({.body = "null", .headers = {}});
    }

   private:
    const std::string path_;
    const std::shared_ptr<Responder> responder_;
  };
};

class ServerGuardTest : public testing::Test {
 protected:
  ThrowingHandler handler;
  Served served{handler};
};

TEST_F(ServerGuardTest, AnswersARequestIfItsHandlerThrows) {
  for (const char* const path : {"/open", "/body", "/end"}) {
    SCOPED_TRACE(path);
    const auto before = loop::exception_count();
    RawClient client(served.port());
    client.send(request("POST", path, {}, "{}"));
    const auto reply = client.reply();
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, 500);
    EXPECT_NE(reply->body.find("send it again"), std::string::npos) << reply->body;
    EXPECT_TRUE(client.closes());
    EXPECT_EQ(loop::exception_count() - before, 1);
  }
  RawClient client(served.port());
  client.send(request("POST", "/well", {}, "{}"));
  EXPECT_EQ(client.reply()->status, 200);
}

TEST_F(ServerGuardTest, AnswersARequestIfItsHandlerForgetsIt) {
  RawClient client(served.port());
  client.send(request("POST", "/drop", {}, "{}"));
  EXPECT_EQ(client.reply()->status, 500);
}

}  // namespace
}  // namespace adit::intake
