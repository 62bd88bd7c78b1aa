#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <future>
#include <string>
#include <thread>
#include <tuple>

#include "asking.hpp"

namespace adit::uplink {
namespace {

using std::chrono::milliseconds;
using testing::AllOf;
using testing::HasSubstr;

// Answered: a complete answer came, with any status.

class AnsweredRequests : public Asking {};

TEST_F(AnsweredRequests, WereRejectedDuringTheirBody) {
  const std::string body = megabytes(20);
  for (int round = 0; round < 10; ++round) {
    const ListeningPeer peer([](Wire& wire) {
      wire.read_head();
      wire.write(answer("429 Too Many Requests", "\"Reduce to <1Hz.\"", "Retry-After: 2\r\n"));
    });  // then it closes with a reset, because most of the body is unread
    Connection connection(loop_, peer.endpoint(), token());
    const Answered got = answered(ask(connection, post(body)));
    EXPECT_EQ(got.status, 429) << got.body;
    EXPECT_EQ(got.body, "\"Reduce to <1Hz.\"");
    EXPECT_EQ(got.retry_after, std::chrono::seconds(2));
    EXPECT_LT(connection.sent_bytes(), body.size());
    EXPECT_FALSE(connection.is_connected()) << "half a request has been sent on it";
  }
}

TEST_F(AnsweredRequests, WereRejectedEarlyByAPeerThatStopsReading) {
  const ListeningPeer peer([](Wire& wire) {
    wire.read_head();
    wire.write(answer("413 Content Too Large", "\"too large\""));
    std::this_thread::sleep_for(milliseconds(100));
  });
  EXPECT_EQ(answered(ask(peer.endpoint(), post(megabytes(20)))).status, 413);
}

/// A 2xx counts once the whole request is sent.
TEST_F(AnsweredRequests, WereAcceptedEarlyByAPeerThatReadsOn) {
  const ListeningPeer peer([](Wire& wire) {
    wire.read_head();
    wire.write(answer("200 OK", "null"));
    wire.wait_for_close();
  });
  Connection connection(loop_, peer.endpoint(), token());
  const std::string body = megabytes(20);
  const Outcome outcome = ask(connection, post(body));
  EXPECT_EQ(answered(outcome).status, 200) << why(outcome);
  EXPECT_EQ(answered(outcome).body, "null");
  EXPECT_GT(connection.sent_bytes(), body.size());
  EXPECT_FALSE(connection.is_connected()) << "bytes after the answer were not read";
}

TEST_F(AnsweredRequests, WereAcceptedBeforeAHeldBackByte) {
  const ListeningPeer peer([](Wire& wire) {
    wire.read_head();
    wire.write(answer("200 OK", "null"));
    wire.wait_for_close();
  });
  Request request = post("body");
  request.last_byte_not_before = loop_.now() + milliseconds(100);
  const loop::Instant not_before = request.last_byte_not_before;
  const Answered got = answered(ask(peer.endpoint(), std::move(request)));
  EXPECT_EQ(got.status, 200) << got.body;
  EXPECT_GE(got.sent.last, not_before);
}

TEST_F(AnsweredRequests, RedactTheTokenOfAnEchoingServer) {
  const ListeningPeer peer([](Wire& wire) {
    wire.read_request();
    wire.write(answer("401 Unauthorized", std::string("\"Authorization: Bearer ") + kToken + "\""));
  });
  EXPECT_EQ(answered(ask(peer.endpoint(), post("{}"))).body, "\"Authorization: Bearer [token]\"");
}

TEST_F(AnsweredRequests, KeepAnAnswerThatIsNoJson) {
  const ListeningPeer peer(
      always(answer("500 Internal Server Error", "<html>Oops</html>", "Content-Type: text/html\r\n")));
  const Answered got = answered(ask(peer.endpoint(), get()));
  EXPECT_EQ(got.status, 500);
  EXPECT_EQ(got.content_type, "text/html");
  EXPECT_EQ(got.body, "<html>Oops</html>");
}

TEST_F(AnsweredRequests, SkipInterimAnswers) {
  const ListeningPeer peer([](Wire& wire) {
    wire.read_request();
    wire.write("HTTP/1.1 102 Processing\r\n\r\n");
    std::this_thread::sleep_for(milliseconds(20));
    wire.write("HTTP/1.1 103 Early Hints\r\n\r\n" + answer("201 Created", "{}"));
  });
  EXPECT_EQ(answered(ask(peer.endpoint(), post("x"))).status, 201);
}

TEST_F(AnsweredRequests, AcceptAChunkedAnswer) {
  const ListeningPeer peer(
      always("HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n2\r\nnu\r\n2\r\nll\r\n0\r\n\r\n"));
  EXPECT_EQ(answered(ask(peer.endpoint(), post("x"))).body, "null");
}

TEST_F(AnsweredRequests, ReconnectIfTheKeptConnectionWasClosed) {
  const std::function<void(Wire&)> ways_to_close[] = {
      [](Wire& wire) { wire.close(); }, [](Wire& wire) { wire.reset(); },
      [](Wire& wire) { wire.write(answer("408 Request Timeout", "\"too slow\"", "Connection: close\r\n")); }};
  for (const auto& close : ways_to_close) {
    std::promise<void> answer_read;
    const ListeningPeer peer({[&](Wire& wire) {
                                wire.read_request();
                                wire.write(answer("200 OK", "\"first\""));
                                answer_read.get_future().wait();
                                close(wire);  // although it announced keep-alive
                              },
                              always(answer("200 OK", "\"second\""))});
    Connection connection(loop_, peer.endpoint(), token());
    EXPECT_EQ(answered(ask(connection, get())).body, "\"first\"");
    answer_read.set_value();
    while (peer.ended() == 0)
      std::this_thread::sleep_for(milliseconds(1));  // the loop does not get to see it
    EXPECT_TRUE(connection.is_connected());
    EXPECT_EQ(answered(ask(connection, get())).body, "\"second\"");
    EXPECT_EQ(peer.begun(), 2);
  }
}

// NeverSent: the kernel got no byte of the request.

class UnsentRequests : public Asking {
 protected:
  std::string never_sent(const Endpoint& endpoint) {
    const Outcome outcome = ask(endpoint, post("x"));
    EXPECT_TRUE(std::holds_alternative<NeverSent>(outcome)) << why(outcome) << answered(outcome).status;
    return why(outcome);
  }
};

TEST_F(UnsentRequests, HadARefusedConnection) {
  const Peer peer({});  // bound, but it does not listen
  const auto port = std::to_string(peer.endpoint().port);
  EXPECT_EQ(never_sent(peer.endpoint()), "connecting to 127.0.0.1:" + port + ": Connection refused");
}

TEST_F(UnsentRequests, NameAnAbsentInterface) {
  const ListeningPeer peer(always(answer("200 OK", "null")));
  Endpoint endpoint = peer.endpoint();
  endpoint.interface = "absent0";
  EXPECT_THAT(never_sent(endpoint), AllOf(HasSubstr("interface absent0"), HasSubstr("No such device")));
  EXPECT_EQ(peer.begun(), 0);
}

TEST_F(UnsentRequests, HadAnInvalidAddress) {
  for (const char* address : {"", "command-post.example", "10.100.1", "10.100.1.300", "::g"}) {
    Endpoint endpoint;
    endpoint.address = address;
    endpoint.port = 80;
    EXPECT_THAT(never_sent(endpoint), HasSubstr("is not an IP address")) << address;
  }
}

TEST_F(UnsentRequests, DidNotConnectInTime) {
  // The backlog is full, so the kernel ignores further connections.
  const loop::FileDescriptor listener(::socket(AF_INET, SOCK_STREAM, 0));
  ASSERT_TRUE(listener);
  ASSERT_EQ(::listen(listener.get(), 0), 0);
  sockaddr_in address{};
  socklen_t size = sizeof address;
  ::getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &size);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::vector<loop::FileDescriptor> before;
  for (int i = 0; i < 3; ++i) {
    before.emplace_back(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0));
    std::ignore = ::connect(before.back().get(), reinterpret_cast<const sockaddr*>(&address), size);
  }
  Endpoint endpoint;
  endpoint.address = "127.0.0.1";
  endpoint.port = ntohs(address.sin_port);
  endpoint.connect_within = milliseconds(100);
  EXPECT_THAT(never_sent(endpoint), HasSubstr("no answer in time"));
}

TEST_F(UnsentRequests, HadANewConnectionClosedAtOnce) {
  const ListeningPeer peer([](Wire&) {});
  Connection connection(loop_, peer.endpoint(), token());
  std::string sentence;
  connection.send(post("x"), [&](const Outcome& outcome) {
    EXPECT_TRUE(std::holds_alternative<NeverSent>(outcome));
    sentence = why(outcome);
  });
  while (peer.ended() == 0)
    std::this_thread::sleep_for(milliseconds(1));  // before the loop sees the connection
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return !connection.busy(); }));
  EXPECT_THAT(sentence, AllOf(HasSubstr("closed the new connection"), HasSubstr("(0 of ")));
}

TEST_F(UnsentRequests, LostTheirConnectionAndCouldNotReconnect) {
  auto peer = std::make_unique<ListeningPeer>([](Wire& wire) {
    wire.read_request();
    wire.write(answer("200 OK", "null"));
  });
  Connection connection(loop_, peer->endpoint(), token());
  EXPECT_EQ(answered(ask(connection, get())).status, 200);
  peer.reset();  // closed, and the port too
  const Outcome outcome = ask(connection, get());
  EXPECT_TRUE(std::holds_alternative<NeverSent>(outcome)) << why(outcome);
  EXPECT_THAT(connection.trouble(), HasSubstr("Connection refused"));
}

}  // namespace
}  // namespace adit::uplink
