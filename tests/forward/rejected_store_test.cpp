#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>

#include "forward/rejected.hpp"
#include "forward/sample_maps.hpp"
#include "host/folder.hpp"
#include "host/service.hpp"
#include "loop/turn_until.hpp"
#include "spool/bytes_read.hpp"
#include "spool/messages.hpp"

namespace adit::forward {
namespace {

namespace fs = std::filesystem;
using spool::markers;
using spool::state;

/// Calls that an origin got.
struct Told {
  int kept = 0, not_kept = 0, let_go = 0;
};

class RejectedStoreTest : public testing::Test {
 protected:
  RejectedStoreTest() { restart(); }
  ~RejectedStoreTest() override { let_go(); }

  /// An orderly restart.
  void restart() {
    let_go();
    rejected_.reset();
    writer_ = std::make_unique<loop::Writer>(loop_);  // the old writer finishes first
    rejected_ = std::make_unique<RejectedStore>(loop_, *writer_, folder_.path());
    rejected_->restore();
  }
  /// What a process would find after a kill at this time.
  std::vector<facts::RejectedRow> found_after_a_kill() {
    loop::Writer writer(loop_);
    RejectedStore other(loop_, writer, folder_.path());
    other.restore();
    return other.rows();
  }

  void add(queues::Message message, int status = 422, const std::string& why = "no",
           std::size_t bytes = 100) {
    rejected_->add(std::move(message), status, why, bytes,
                   {.on_stored = [this](bool kept) { ++(kept ? told_.kept : told_.not_kept); },
                    .release = [this] { ++told_.let_go; }});
  }

  /// Blocks the writer until let_go().
  void hold() {
    held_.emplace();
    writer_->submit([until = held_->get_future().share()] { until.wait(); }, [] {});
  }
  void let_go() {
    if (held_) held_->set_value();
    held_.reset();
  }
  /// Waits for the writer.
  void settle() { ASSERT_TRUE(loop::turn_until_idle(loop_, *writer_)); }

  host::Folder folder_;
  loop::Loop loop_;
  Told told_;
  std::optional<std::promise<void>> held_;
  std::unique_ptr<loop::Writer> writer_;
  std::unique_ptr<RejectedStore> rejected_;
};

icd::MapUpdate grid(double x = 0, std::uint32_t side = 2) {
  icd::MapUpdate map = grid_of("r1", side, 7, x, 0.1);
  map.data.compression = icd::Compression::Gzip;  // as stored grids say
  return map;
}

TEST_F(RejectedStoreTest, KeepsMessagesAndReasonsAcrossARestart) {
  add(grid(), 422, "no \"such\" robot", 100);
  add(state(), 500, "it failed", 200);
  add(markers(), 413, "too long", 300);
  const auto before = rejected_->rows();
  restart();
  const auto rows = rejected_->rows();
  ASSERT_EQ(rows.size(), 3);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].number, i + 1);
    EXPECT_EQ(rows[i].kind, before[i].kind);
    EXPECT_EQ(rows[i].robot, before[i].robot);
    EXPECT_EQ(rows[i].status, before[i].status);
    EXPECT_EQ(rows[i].why, before[i].why);
    EXPECT_EQ(rows[i].bytes, before[i].bytes);
    EXPECT_NEAR(rows[i].at, before[i].at, 1e-3);
  }
  EXPECT_EQ(rows[0].kind, "grid");
  EXPECT_EQ(rows[1].robot, "r2");
  const auto map = rejected_->begin_resend(1);
  ASSERT_TRUE(map);
  EXPECT_EQ(std::get<icd::MapUpdate>(map->message).data.raw_size, 4);
}

TEST_F(RejectedStoreTest, KeepsItsAgesAtAClockStep) {
  add(grid());
  for (const double step : {3e8, -6e8}) {
    loop_.set_wall(loop_.wall_now() + step);
    EXPECT_NEAR(rejected_->rows().at(0).at, loop_.wall_now(), 60);
  }
  settle();
  restart();
  EXPECT_NEAR(rejected_->rows().at(0).at, loop_.wall_now(), 60) << "after a restart";
}

TEST_F(RejectedStoreTest, ForgetsRetriedAndDiscardedMessages) {
  add(grid());
  add(state(), 500);
  EXPECT_TRUE(rejected_->begin_resend(1));
  EXPECT_FALSE(rejected_->begin_resend(1));
  EXPECT_FALSE(rejected_->discard(1));
  rejected_->finish_resend(1, true);
  EXPECT_FALSE(rejected_->begin_resend(1));
  EXPECT_TRUE(rejected_->discard(2));
  EXPECT_EQ(rejected_->discard(2).error(), "there is no rejected message 2");
  settle();
  EXPECT_TRUE(fs::is_empty(folder_.path()));
  restart();
  EXPECT_TRUE(rejected_->rows().empty());
}

TEST_F(RejectedStoreTest, RetriesNoReplacedMessage) {
  add(grid());
  rejected_->mark_contained(grid(0, 5));
  EXPECT_TRUE(rejected_->rows().front().replaced);
  const auto sent = rejected_->begin_resend(1);
  ASSERT_FALSE(sent);
  EXPECT_NE(sent.error().find("newer"), std::string::npos);
  restart();
  EXPECT_TRUE(rejected_->rows().front().replaced) << "after a restart";
  EXPECT_TRUE(rejected_->discard(1));
}

TEST_F(RejectedStoreTest, KeepsWhatAGridReplacedAcrossARestart) {
  const auto bounds = [](double x) {
    return icd::GridBounds::from_grid(std::get<icd::OccupancyGrid>(grid(x).msg));
  };
  add(grid());
  rejected_->add(grid(0.04), 422, "no", 100, {}, icd::joint_bounds(bounds(0.04), bounds(0.08)));
  ASSERT_EQ(rejected_->rows().size(), 1u) << "replaced the first";
  for (int i = 0; i < 2; ++i) {
    rejected_->mark_contained(grid(0.07));
    rejected_->mark_contained(grid(0.01));
    EXPECT_FALSE(rejected_->rows().front().replaced) << "70 mm of one or the other are outside";
    settle();
    restart();
  }
  const auto item = rejected_->begin_resend(2);
  ASSERT_TRUE(item && item->bounds);
  EXPECT_NEAR(item->bounds->low.x, -0.04, 1e-9);
  EXPECT_NEAR(item->bounds->high.x, 0.24, 1e-9);
  rejected_->mark_contained(grid(0.04));
  EXPECT_TRUE(rejected_->rows().empty()) << "it is being sent";
  rejected_->finish_resend(2, false);
  EXPECT_TRUE(rejected_->rows().front().replaced);
}

TEST_F(RejectedStoreTest, ConfirmsThatAReplacementIsStored) {
  add(grid());
  settle();
  int written = 0;
  EXPECT_FALSE(rejected_->mark_contained(state(), [&] { ++written; })) << "replaces nothing";
  hold();
  EXPECT_TRUE(rejected_->mark_contained(grid(), [&] { ++written; }));
  EXPECT_FALSE(rejected_->mark_contained(grid(), [&] { ++written; })) << "replaced before";
  EXPECT_FALSE(found_after_a_kill().front().replaced);
  EXPECT_FALSE(rejected_->has_stored_all());
  EXPECT_EQ(written, 0);
  let_go();
  settle();
  EXPECT_TRUE(rejected_->has_stored_all());
  EXPECT_EQ(written, 1);
  EXPECT_TRUE(found_after_a_kill().front().replaced);
}

TEST_F(RejectedStoreTest, CountsDroppedMessages) {
  for (int i = 0; i < 5; ++i) add(state());
  EXPECT_EQ(rejected_->dropped_count(), 0) << "the newer state replaces them";
  for (std::size_t i = 0; i < queues::RejectedMessages::kMostItems + 3; ++i) {
    add(grid(static_cast<double>(i)));
  }
  EXPECT_EQ(rejected_->dropped_count(), 4);
}

TEST_F(RejectedStoreTest, KeepsDamagedFilesAside) {
  add(grid());
  add(state());
  settle();
  folder_.put("1.json", "{");
  folder_.put("9.json", "{}");
  folder_.put("x.json.part", "{}");
  restart();
  ASSERT_EQ(rejected_->rows().size(), 1);
  EXPECT_EQ(rejected_->rows().front().number, 2);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "1.json.damaged"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "1.cbor.damaged")) << "the message is kept";
  EXPECT_TRUE(
      rejected_->missing().starts_with("rejected messages are damaged: " + (folder_ / "1.cbor") + ": "))
      << rejected_->missing();
  restart();
  EXPECT_EQ(rejected_->missing(), "");
}

TEST_F(RejectedStoreTest, NamesAFileThatCannotBeRead) {
  add(grid());
  settle();
  fs::create_directory(folder_ / "2.json");
  restart();
  EXPECT_EQ(rejected_->missing(), "rejected messages cannot be read: cannot read " + (folder_ / "2.json") +
                                      ": is not a regular file");
}

TEST_F(RejectedStoreTest, ReleasesTheOriginOnceTheMessageIsStored) {
  hold();
  add(grid());
  for (int i = 0; i < 10; ++i) loop_.turn(std::chrono::milliseconds{5});
  EXPECT_EQ(rejected_->rows().size(), 1u) << "listed at once";
  EXPECT_FALSE(rejected_->has_stored_all());
  EXPECT_EQ(told_.kept + told_.let_go, 0);
  EXPECT_TRUE(found_after_a_kill().empty()) << "the origin still has it";
  let_go();
  settle();
  EXPECT_TRUE(rejected_->has_stored_all());
  EXPECT_EQ(told_.kept, 1);
  EXPECT_EQ(told_.let_go, 1);
  EXPECT_EQ(found_after_a_kill().size(), 1u);
}

TEST_F(RejectedStoreTest, FinishesItsWritesAtAStop) {
  hold();
  add(grid());
  restart();
  EXPECT_EQ(rejected_->rows().size(), 1u);
}

TEST_F(RejectedStoreTest, KeepsARetriedMessageUntilItIsQueued) {
  add(grid());
  settle();
  ASSERT_TRUE(rejected_->begin_resend(1));
  EXPECT_TRUE(rejected_->rows().empty()) << "it cannot be sent twice";
  settle();
  EXPECT_EQ(found_after_a_kill().size(), 1u);
  rejected_->finish_resend(1, true);
  settle();
  EXPECT_TRUE(found_after_a_kill().empty());
}

TEST_F(RejectedStoreTest, DetectsAReplacementDuringARetry) {
  add(grid());
  add(state());
  ASSERT_TRUE(rejected_->begin_resend(1));
  ASSERT_TRUE(rejected_->begin_resend(2));
  rejected_->mark_contained(grid());
  EXPECT_FALSE(rejected_->finish_resend(1, true));
  EXPECT_TRUE(rejected_->finish_resend(2, true));
}

TEST_F(RejectedStoreTest, RestoresAMessageIfItsRetryFails) {
  add(grid());
  settle();
  ASSERT_TRUE(rejected_->begin_resend(1));
  rejected_->finish_resend(1, false);
  EXPECT_EQ(rejected_->rows().size(), 1u);
  EXPECT_TRUE(rejected_->begin_resend(1));
}

TEST_F(RejectedStoreTest, KeepsTheOriginIfAWriteFails) {
  folder_.put("in the way", "");
  rejected_ = std::make_unique<RejectedStore>(loop_, *writer_, folder_ / "in the way/rejected");
  add(grid());
  add(state());
  settle();
  EXPECT_EQ(rejected_->rows().size(), 2u) << "in memory";
  EXPECT_EQ(told_.not_kept, 2);
  EXPECT_EQ(told_.let_go, 0);
  ASSERT_TRUE(rejected_->discard(1));
  EXPECT_EQ(told_.let_go, 1);
  ASSERT_TRUE(rejected_->begin_resend(2));
  EXPECT_EQ(told_.let_go, 1);
  rejected_->finish_resend(2, true);
  EXPECT_EQ(told_.let_go, 2);
}

TEST_F(RejectedStoreTest, StartsWithoutReadingMapData) {
  add(spool::cloud(1'000'000));  // 12 MB
  const auto before = spool::BytesRead::of(folder_.path());
  restart();
  const auto after = spool::BytesRead::of(folder_.path());
  EXPECT_LT(after.by_calls - before.by_calls, 1'000'000U);
  EXPECT_LT(after.in_mappings, 1'000'000U);
  const auto map = rejected_->begin_resend(1);
  ASSERT_TRUE(map);
  EXPECT_EQ(std::get<icd::MapUpdate>(map->message), spool::cloud(1'000'000));
}

TEST_F(RejectedStoreTest, OverwritesNoUnreadFile) {
  folder_.put("rejected", "no folder");
  rejected_ = std::make_unique<RejectedStore>(loop_, *writer_, folder_ / "rejected");
  rejected_->restore();
  fs::remove(folder_ / "rejected");
  fs::create_directory(folder_ / "rejected");
  folder_.put("rejected/1.cbor", "of an earlier process");
  add(grid());
  settle();
  EXPECT_EQ(told_.not_kept, 1);
  ASSERT_TRUE(rejected_->discard(1));
  settle();
  EXPECT_EQ(host::read_file(folder_ / "rejected/1.cbor"), "of an earlier process");
}

/// Otherwise a restart would send the older message after the newer one.
TEST_F(RejectedStoreTest, ReleasesTheOriginOfAReplacedMessage) {
  folder_.put("in the way", "");
  rejected_ = std::make_unique<RejectedStore>(loop_, *writer_, folder_ / "in the way/rejected");
  add(grid());
  settle();
  EXPECT_FALSE(rejected_->mark_contained(grid()));
  EXPECT_EQ(told_.let_go, 1);
  hold();
  add(grid(9));
  rejected_->mark_contained(grid(9));
  EXPECT_EQ(told_.let_go, 1) << "its write is pending";
  let_go();
  settle();
  EXPECT_EQ(told_.not_kept, 2);
  EXPECT_EQ(told_.let_go, 2);
}

}  // namespace
}  // namespace adit::forward
