#include "forward/scoring.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "../uplink/peer.hpp"
#include "host/folder.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {
namespace {

using namespace std::chrono_literals;

constexpr const char* kStatus = R"({"score":1,"run_clock":10.0,"remaining_reports":24,"current_team":"a"})";

/// A Command Post that answers so late, and with that.
uplink::Peer::Script serving(const char* body, std::chrono::milliseconds late) {
  return [body, late](uplink::Wire& wire) {
    for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      std::this_thread::sleep_for(late);
      if (!wire.write(uplink::answer("200 OK", body))) return;
    }
  };
}

class Asker final : public intake::Responder {
 public:
  void answer(intake::Answer answer) override { heard = std::move(answer); }
  std::shared_ptr<intake::Stream> stream(std::string_view) override { return nullptr; }
  bool client_gone() const override { return false; }
  std::optional<intake::Answer> heard;
};

/// What it hears who asks before the first answer has come.
std::optional<intake::Answer> heard_from(uplink::Peer::Script post) {
  uplink::ListeningPeer peer{std::vector<uplink::Peer::Script>{std::move(post)}};
  settings::Settings settings;
  settings.command_post.scoring = {peer.endpoint().address, peer.endpoint().port};
  const host::Folder ledger_folder, journal_folder;
  loop::Loop loop;
  std::mt19937_64 random{1};
  Record record{[] {}};
  journal::Journal journal{loop, journal_folder.path()};
  journal.begin({.boot = "b", .at = loop.now(), .stamp = loop.stamp_now()});
  auto ledger = std::move(*ledger::Ledger::open(ledger_folder.path()));
  Scoring scoring{loop, ledger, settings, icd::BearerToken::parse("a-token"), record, random, journal, [] {}};
  if (!scoring.start()) return std::nullopt;
  const auto asker = std::make_shared<Asker>();
  scoring.status(asker);
  const bool heard = loop::turn_until(loop, [&] {
    scoring.tick();
    return asker->heard.has_value();
  });
  return heard ? asker->heard : std::nullopt;
}

TEST(Scoring, TellsAStatusThatCameLateWithTheAgeOfItsQuestion) {
  const auto heard = heard_from(serving(kStatus, 1200ms));
  ASSERT_TRUE(heard.has_value());
  EXPECT_EQ(heard->status, icd::Status::Ok);
  EXPECT_EQ(heard->body, kStatus);
  ASSERT_EQ(heard->headers.size(), 1U);
  EXPECT_EQ(heard->headers.front().name, "Age");
  EXPECT_EQ(heard->headers.front().value, "1");
}

TEST(Scoring, DoesNotPassOnWhatIsNoStatus) {
  const auto heard = heard_from(serving(R"("ok")", 0ms));
  ASSERT_TRUE(heard.has_value());
  EXPECT_EQ(heard->status, icd::Status::BadGateway);
}

}  // namespace
}  // namespace adit::forward
