#include "forward/flow.hpp"

#include <gmock/gmock.h>

#include "host/folder.hpp"
#include "loop/turn_until.hpp"
#include "spool/messages.hpp"

namespace adit::forward {
namespace {

using testing::ElementsAre;

/// Without tokens nothing leaves: what is taken waits.
class FlowTest : public testing::Test {
 protected:
  void SetUp() override { live(); }
  void live() {
    flow_.reset();
    flow_.emplace(loop_, ledger_, settings_,
                  Tokens{.scoring = {}, .mapping = {}, .all = {*icd::BearerToken::parse("a-secret")}},
                  Flow::Folders{folder_.path(), folder_.path()}, std::nullopt,
                  Flow::Told{.changed = [] {},
                             .anew = [this] { anew_ = true; },
                             .posted = [this](const std::string& name) { posted_.push_back(name); }});
    ASSERT_TRUE(flow_->start());
  }
  icd::Checked<void> take_map() {
    std::optional<icd::Checked<void>> said;
    flow_->map_arrives()->take(spool::cloud(3), sender_,
                               [&](icd::Checked<void> taken) { said = std::move(taken); });
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return said.has_value(); }));
    return said.value_or(std::unexpected(icd::Refusal{icd::Status::Ok, "nothing was said"}));
  }
  std::vector<std::uint64_t> waiting() const {
    std::vector<std::uint64_t> waiting;
    for (const page::ActivityRow& row : flow_->activities()) waiting.push_back(row.waiting);
    return waiting;
  }

  const intake::Sender sender_{.address = "10.0.0.5", .bytes = 10, .connection = 1};
  host::Folder folder_;
  loop::Loop loop_;
  settings::Settings settings_;
  ledger::Ledger ledger_ = std::move(*ledger::Ledger::open(folder_.path()));
  std::vector<std::string> posted_;
  bool anew_ = false;
  std::optional<Flow> flow_;
};

TEST_F(FlowTest, WhatItTookWaitsInTheNextLife) {
  ASSERT_TRUE(take_map());
  ASSERT_TRUE(flow_->take(spool::state(), sender_));
  ASSERT_TRUE(flow_->take(spool::markers(), sender_));
  EXPECT_THAT(waiting(), ElementsAre(1, 1, 1));
  live();
  EXPECT_THAT(waiting(), ElementsAre(1, 1, 1));
}

TEST_F(FlowTest, TellsWhichRobotsPost) {
  ASSERT_TRUE(take_map());
  ASSERT_TRUE(flow_->take(spool::state(), sender_));
  EXPECT_THAT(posted_, ElementsAre("r1", "r2"));
}

TEST_F(FlowTest, QuotesNoToken) {
  flow_->refused(icd::Uri::StateUpdate, sender_, {icd::Status::UnprocessableEntity, "name: got a-secret", 0});
  ASSERT_EQ(flow_->record().refusals().size(), 1);
  EXPECT_THAT(flow_->record().refusals().front().sentence, testing::Not(testing::HasSubstr("a-secret")));
}

TEST_F(FlowTest, EndsAndSendsNothingSetAsideFromThenOn) {
  bool over = false;
  EXPECT_FALSE(flow_->is_ending());
  flow_->end([&] { over = true; });
  EXPECT_TRUE(flow_->is_ending());
  EXPECT_FALSE(flow_->aside(1, page::AsideDeed::Discard));
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return over; }));
  EXPECT_FALSE(anew_);
}

}  // namespace
}  // namespace adit::forward
