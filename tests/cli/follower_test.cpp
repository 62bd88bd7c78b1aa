#include "cli/follower.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "cli/server.hpp"
#include "cli/view.hpp"
#include "codec/json.hpp"
#include "codec/patch.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string whole(const api::RunView& view) {
  return "data: " + codec::to_json(view) + "\n\n";
}

std::string patch(const std::string& json) {
  return "event: patch\ndata: " + json + "\n\n";
}

std::string stream(const std::string& events) {
  return "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\n\r\n" + events;
}

/// A follower of a server that the test controls.
class Following {
 public:
  explicit Following(const Server& server)
      : adit_{server.address(), {*icd::BearerToken::parse("sesame-1"), ""}} {}

  /// Waits for the next new view.
  FetchResult next() {
    while (true) {
      if (auto look = follower_.poll()) return *std::move(look);
      const auto left =
          std::chrono::ceil<std::chrono::milliseconds>(follower_.due() - Follower::Clock::now());
      pollfd entry{follower_.fd(), POLLIN, 0};
      poll(&entry, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    }
  }
  /// The number of reports left in the next view, or the message in its place.
  std::string left() {
    const FetchResult look = next();
    return look ? std::to_string(look->view.run->remaining_reports) : look.error();
  }
  const Follower& follower() const { return follower_; }

 private:
  Adit adit_;
  Follower follower_{adit_};
};

TEST(Follower, ReadsTheWholeViewAndThenItsChanges) {
  api::RunView now = sample_view();
  now.run->remaining_reports = 3;
  now.reports.insert(now.reports.begin(), now.reports.front())->number = 4;
  const std::string change = codec::write_json(*codec::patch(sample_view(), now));
  const Server server(stream(whole(sample_view()) + patch(change)), true);
  Following following(server);
  FetchResult look = following.next();
  if (look && look->view.run->remaining_reports == 18) look = following.next();  // they arrived one by one
  ASSERT_TRUE(look) << look.error();
  EXPECT_EQ(codec::write_json(look->told), codec::write_json(codec::parse_json(codec::to_json(now)).value()));
  EXPECT_EQ(codec::to_json(look->view), codec::to_json(now));
  EXPECT_EQ(server.request().substr(0, 21), "GET /adit/events HTTP");
}

TEST(Follower, ReconnectsIfTheEventsEnd) {
  const Server server(stream(whole(sample_view())));
  Following following(server);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(following.left(), "18");
}

TEST(Follower, PollsTheViewIfEventsAreRejected) {
  const Server server(Server::Answers{
      {"GET /adit/events", Server::reply("503 Service Unavailable", "\"as many pages are open as ...\"")},
      {"GET /adit/run", Server::ok(codec::to_json(sample_view()))}});
  Following following(server);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(following.left(), "18");
}

TEST(Follower, TellsWhyThereIsNoView) {
  const auto error_of = [](const std::string& answer) {
    const Server server(answer);
    return Following(server).left();
  };
  EXPECT_THAT(error_of(Server::reply("401 Unauthorized", "\"who are you?\"")),
              HasSubstr("rejects the token"));
  EXPECT_THAT(error_of(stream(whole(sample_view()) + patch(R"({"reports":{"length":-1}})"))),
              HasSubstr("cannot read an event"));
  EXPECT_THAT(error_of(stream("data: {\n\n")), HasSubstr("cannot read an event"));
  EXPECT_THAT(error_of(stream("data: {}\n\n")), HasSubstr("it is another version"));
  EXPECT_THAT(error_of(stream("")), HasSubstr("closed by the server"));
  EXPECT_THAT(error_of(""), HasSubstr("did not answer"));
}

TEST(Follower, ReportsThatAditIsUnreachableAndRetries) {
  std::optional<Server> server(std::in_place, "");
  Following following(*server);
  server.reset();
  for (int i = 0; i < 2; ++i) EXPECT_THAT(following.left(), HasSubstr("Connection refused"));
}

TEST(Follower, TreatsALongSilenceAsALoss) {
  const Server server(stream(whole(sample_view())), true);
  Following following(server);
  EXPECT_EQ(following.left(), "18");
  EXPECT_GT(following.follower().due(), Follower::Clock::now() + std::chrono::seconds(2))
      << "the server was silent for longer than a heartbeat";
  EXPECT_THAT(following.left(), StartsWith("lost the connection to Adit at 127.0.0.1:"));
}

constexpr std::string_view kStream =
    "retry: 1000\ndata: {\"now\":1}\n\n:\n\nevent: patch\ndata: {\"now\":2}\n\ndata: {\"now\":3}\n\ndata: "
    "{\"no";

/// Parses "type data" from pieces of `piece` bytes.
std::vector<std::string> events(std::size_t piece) {
  EventReader reader;
  std::vector<std::string> all;
  for (std::size_t at = 0; at < kStream.size(); at += piece) {
    reader.feed(kStream.substr(at, piece));
    while (const auto event = reader.next()) all.push_back(event->type + ' ' + event->data);
  }
  EXPECT_EQ(reader.waiting(), 10);
  return all;
}

TEST(EventReader, GivesEachWholeEventFromAnyPieces) {
  const std::vector<std::string> all = {" {\"now\":1}", "patch {\"now\":2}", " {\"now\":3}"};
  for (std::size_t piece = 1; piece <= kStream.size(); ++piece) EXPECT_EQ(events(piece), all) << piece;
}

}  // namespace
}  // namespace adit::cli
