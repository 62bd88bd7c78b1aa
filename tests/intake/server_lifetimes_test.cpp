#include <gtest/gtest.h>

#include "intake/raw_client.hpp"
#include "intake/scripted_handler.hpp"
#include "intake/served.hpp"

/// Client, request, responder, stream and server end in any order. The address sanitizer detects most faults.
namespace adit::intake {
namespace {

using std::chrono::milliseconds;

class ServerLifetimes : public testing::Test {
 protected:
  ScriptedHandler handler;
  Served served{handler};
  RawClient client{served.port()};

  bool no_connections() {
    return served.eventually([&] { return served.server().connections() == 0; });
  }
};

TEST_F(ServerLifetimes, ClientResetsBeforeItsAnswer) {
  client.send(request("POST", "/later", {}, "x"));
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  client.reset();
  EXPECT_TRUE(served.eventually([&] { return handler.responders[0]->is_client_gone(); }));
  EXPECT_TRUE(no_connections());
  EXPECT_EQ(handler.gone, 1);
  EXPECT_EQ(handler.exchanges, 0);
  served.on_loop([&] {
    handler.responders[0]->answer({.body = "1", .headers = {}});
    EXPECT_FALSE(handler.responders[0]->stream("text/plain")->send("x"));
  });
}

TEST_F(ServerLifetimes, ClientResetsBeforeTheAnswerToItsChunks) {
  client.send(request("POST", "/later", "Transfer-Encoding: chunked\r\n") + "1\r\nx\r\n0\r\n\r\n");
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  client.reset();
  EXPECT_TRUE(no_connections());
  EXPECT_EQ(handler.gone, 1);
  EXPECT_EQ(handler.exchanges, 0);
  served.on_loop([&] { handler.responders[0]->answer({.body = "1", .headers = {}}); });
}

TEST_F(ServerLifetimes, AnswerClosesAConnectionOnRequest) {
  client.close();
  for (const std::string_view head :
       {"GET /echo HTTP/1.1\r\nHost: adit\r\nConnection: Close\r\n\r\n", "GET /echo HTTP/1.0\r\n\r\n"}) {
    RawClient asks(served.port());
    asks.send(head);
    EXPECT_EQ(asks.reply()->status, 200) << head;
    EXPECT_TRUE(no_connections()) << head;
  }
}

TEST_F(ServerLifetimes, ClientResetsInItsHead) {
  client.send("GET /echo HT");
  ASSERT_TRUE(served.eventually([&] { return served.server().connections() == 1; }));
  client.reset();
  EXPECT_TRUE(no_connections());
}

TEST_F(ServerLifetimes, ClientResetsInItsBody) {
  client.send("POST /echo HTTP/1.1\r\nHost: adit\r\nContent-Length: 100\r\n\r\nbegun");
  ASSERT_TRUE(served.eventually([&] { return handler.body_bytes == 5; }));
  client.reset();
  EXPECT_TRUE(no_connections());
  EXPECT_EQ(handler.gone, 1);
  EXPECT_EQ(handler.ends, 0);
}

TEST_F(ServerLifetimes, ClientClosesAfterItsLastBytes) {
  for (const std::string text :
       {"GET /echo HT", "POST /echo HTTP/1.1\r\nHost: adit\r\nContent-Length: 100\r\n\r\nbegun"}) {
    RawClient brief(served.port());
    brief.send(text);
    brief.close();
  }
  client.close();
  EXPECT_TRUE(served.eventually([&] { return handler.gone == 1 && served.server().connections() == 0; }));
  EXPECT_EQ(handler.exchanges, 0);
  EXPECT_EQ(handler.ends, 0);
}

TEST_F(ServerLifetimes, ClientResetsWhileItsBodyIsHeldBack) {
  client.send("POST /held HTTP/1.1\r\nHost: adit\r\nContent-Length: 100\r\n\r\nbegun");
  ASSERT_TRUE(served.eventually([&] { return handler.flows.size() == 1; }));
  client.reset();
  EXPECT_TRUE(no_connections());
  EXPECT_EQ(handler.gone, 1);
  served.on_loop([&] { handler.flows[0]->resume(); });
}

TEST_F(ServerLifetimes, ClientResetsAStream) {
  client.send(request("GET", "/stream"));
  ASSERT_TRUE(served.eventually([&] { return handler.streams.size() == 1; }));
  served.on_loop([&] { EXPECT_TRUE(handler.streams[0]->send("x")); });
  ASSERT_TRUE(client.wait_for("x"));
  client.reset();
  EXPECT_TRUE(served.eventually([&] { return !handler.streams[0]->send("y"); }));
  EXPECT_TRUE(no_connections());
}

TEST_F(ServerLifetimes, ClientClosesAStream) {
  client.send(request("GET", "/stream"));
  ASSERT_TRUE(served.eventually([&] { return handler.streams.size() == 1; }));
  client.close();
  EXPECT_TRUE(served.eventually([&] { return !handler.streams[0]->send("y"); }));
  EXPECT_TRUE(no_connections());
}

TEST_F(ServerLifetimes, ClientResetsAfterARejectionInItsBody) {
  client.send("POST /midway HTTP/1.1\r\nHost: adit\r\nContent-Length: 5000000\r\n\r\nbegun");
  ASSERT_TRUE(client.reply());
  client.reset();
  EXPECT_TRUE(no_connections());
  EXPECT_EQ(handler.gone, 0);
}

TEST_F(ServerLifetimes, ResponderAnswersDuringAReset) {
  for (int i = 0; i < 50; ++i) {
    RawClient racing(served.port());
    racing.send(request("GET", "/later"));
    std::vector<std::shared_ptr<Responder>> own;  // not the next client's
    ASSERT_TRUE(served.eventually([&] {
      own = std::exchange(handler.responders, {});
      return own.size() == 1;
    }));
    served.loop().post([own = std::move(own)] { own[0]->answer({.body = "1", .headers = {}}); });
    racing.reset();
  }
  client.close();
  EXPECT_TRUE(no_connections());
}

TEST_F(ServerLifetimes, ServerEndsWithARequestInEachPhase) {
  std::vector<std::unique_ptr<RawClient>> clients;
  const std::string unfinished = " HTTP/1.1\r\nHost: adit\r\nContent-Length: 5000000\r\n\r\nbegun";
  const std::string chunk = " HTTP/1.1\r\nHost: adit\r\nTransfer-Encoding: chunked\r\n\r\n5\r\nbegun\r\n";
  for (const std::string& text :
       {std::string("GET /echo HT"), "POST /echo" + chunk, "POST /held" + chunk,
        "POST /later" + chunk + "0\r\n\r\n", "POST /echo" + unfinished, "POST /held" + unfinished,
        "POST /midway" + unfinished, "POST /eager" + unfinished, request("GET", "/later"),
        request("GET", "/stream"), request("GET", "/echo"),
        std::string("POST /refuse HTTP/1.1\r\nHost: adit\r\nContent-Length: 10\r\n\r\n")}) {
    clients.push_back(std::make_unique<RawClient>(served.port()));
    clients.back()->send(text);
  }
  ASSERT_TRUE(served.eventually([&] {
    return handler.responders.size() == 3 && handler.streams.size() == 1 && handler.flows.size() == 2 &&
           handler.body_bytes == 7 * std::string_view("begun").size();
  }));
  served.on_loop([&] {
    handler.streams[0]->send("x");
    served.destroy_server();
    EXPECT_EQ(handler.exchanges, 0);
    EXPECT_EQ(handler.gone, 7);
    for (auto& responder : handler.responders) {
      EXPECT_TRUE(responder->is_client_gone());
      responder->answer({.body = "late", .headers = {}});
    }
    for (auto& flow : handler.flows) flow->resume();
    EXPECT_FALSE(handler.streams[0]->send("late"));
    handler.streams.clear();
    handler.responders.clear();
    handler.flows.clear();
  });
  for (auto& each : clients) EXPECT_TRUE(each->closes());
}

TEST_F(ServerLifetimes, ServerEndsWithAnswersUnsent) {
  for (int i = 0; i < 5; ++i) client.send(request("GET", "/later"));
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  served.on_loop([&] {
    handler.responders[0]->answer({.body = "1", .headers = {}});
    served.destroy_server();
  });
  EXPECT_TRUE(client.closes());
}

TEST_F(ServerLifetimes, ResponderEndsWithoutAnAnswer) {
  client.send(request("GET", "/later"));
  ASSERT_TRUE(served.eventually([&] { return handler.responders.size() == 1; }));
  served.on_loop([&] { handler.responders.clear(); });
  client.close();
  served.on_loop([&] { served.destroy_server(); });
  EXPECT_EQ(handler.exchanges, 0);
}

TEST_F(ServerLifetimes, ManyClientsEndInEachPhase) {
  std::vector<std::thread> crowd;
  crowd.reserve(8);
  for (int who = 0; who < 8; ++who) {
    crowd.emplace_back([this, who] {
      const std::string source = "127.0.2." + std::to_string(who + 1);
      for (int i = 0; i < 30; ++i) {
        RawClient one(served.port(), source);
        const std::string paths[] = {"/echo", "/later", "/held", "/midway", "/stream", "/refuse"};
        const std::string& path = paths[static_cast<std::size_t>(i * 7 + who) % std::size(paths)];
        one.send(request(path == "/stream" ? "GET" : "POST", path, {}, std::string(1000, 'x')));
        if (i % 3 == 0) one.reply(milliseconds(5));
        if (i % 2 == 0) one.reset();
      }
    });
  }
  std::atomic<bool> over = false;
  std::thread answering([&] {
    while (!over) {
      served.on_loop([&] {
        for (auto& each : std::exchange(handler.responders, {})) each->answer({.body = "1", .headers = {}});
        for (auto& each : std::exchange(handler.flows, {})) each->resume();
        for (auto& each : std::exchange(handler.streams, {})) each->send("x");
      });
      std::this_thread::sleep_for(milliseconds(1));
    }
  });
  for (auto& each : crowd) each.join();
  client.close();
  EXPECT_TRUE(no_connections());
  over = true;
  answering.join();
  EXPECT_EQ(handler.exchanges, 0);
}

}  // namespace
}  // namespace adit::intake
