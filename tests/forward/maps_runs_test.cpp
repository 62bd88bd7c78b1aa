// Stitched grids at a run change: they do not overwrite cells of the Command Post with unknown ones.
#include <gmock/gmock.h>

#include <future>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "../uplink/peer.hpp"
#include "codec/body_decoder.hpp"
#include "codec/gzip.hpp"
#include "codec/read.hpp"
#include "forward/flow.hpp"
#include "host/folder.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {
namespace {

using testing::ElementsAreArray;

constexpr std::uint32_t kWidth = 16;  // cells of the observed area
constexpr std::uint8_t kUnknown = icd::kUnknownCell;
using Area = std::vector<std::uint8_t>;

struct RunState {
  double clock = 600;
  int left = 14;
  std::string run = "1";
};

/// Both endpoints at one address. Its map has each cell that was sent.
class CommandPostStub {
 public:
  settings::Address address() const { return {peer_.endpoint().address, peer_.endpoint().port}; }
  void says(const RunState& says) {
    const std::lock_guard lock(mutex_);
    says_ = says;
  }
  /// Begins a run with an empty map.
  void begins_run(const RunState& says) {
    const std::lock_guard lock(mutex_);
    says_ = says;
    area_ = Area(kWidth, kUnknown);
  }
  Area area() const {
    const std::lock_guard lock(mutex_);
    return area_;
  }
  int maps() const {
    const std::lock_guard lock(mutex_);
    return maps_;
  }

 private:
  void serve(uplink::Wire& wire) {
    for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      if (!wire.write(uplink::answer("200 OK", answer_to(request)))) return;
    }
  }
  std::string answer_to(const std::string& request) {
    if (request.starts_with("GET")) return run(true);
    if (request.starts_with("POST /api/")) return run(false);
    draw(request.substr(request.find("\r\n\r\n") + 4));
    return "null";
  }
  std::string run(bool is_status) const {
    const std::lock_guard lock(mutex_);
    std::ostringstream json;
    json << R"({"run_clock":)" << says_.clock;
    if (is_status) {
      json << R"(,"score":1,"remaining_reports":)" << says_.left << R"(,"current_team":"a"})";
    } else {
      json << R"(,"run":")" << says_.run
           << R"(","url":"","id":1,"x":1,"team":"a","report_status":"scored","score_change":0})";
    }
    return json.str();
  }
  void draw(const std::string& body) {
    auto document = codec::decode({codec::Format::Cbor, {}}, codec::Split::MapData, body);
    ASSERT_TRUE(document);
    const auto map = codec::read_map_update(*std::move(document), {});
    ASSERT_TRUE(map);
    const auto first = static_cast<std::size_t>(std::get<icd::OccupancyGrid>(map->msg).origin.position.x);
    std::size_t i = first;
    const std::lock_guard lock(mutex_);
    ++maps_;
    const auto drawn = codec::for_each_piece(map->data, [&](auto piece) -> icd::Checked<void> {
      for (const std::uint8_t cell : piece) {
        if (i < area_.size()) area_[i] = cell;
        ++i;
      }
      return {};
    });
    ASSERT_TRUE(drawn);
  }

  mutable std::mutex mutex_;
  RunState says_;
  Area area_ = Area(kWidth, kUnknown);
  int maps_ = 0;
  std::vector<std::jthread> connections_;
  uplink::ListeningPeer peer_{std::vector<uplink::Peer::Script>{[this](uplink::Wire& wire) {
    connections_.emplace_back([this, its = std::move(wire)]() mutable { serve(its); });
  }}};
};

/// One row of cells of 1 m.
icd::MapUpdate part_at(double x, std::uint32_t width, std::uint8_t value) {
  icd::OccupancyGrid grid;
  grid.resolution = 1;
  grid.width = width;
  grid.height = 1;
  grid.origin.position.x = x;
  const std::vector<std::uint8_t> cells(width, value);
  return {
      icd::RobotName::parse("r1"), grid, {icd::ChunkedBytes{cells}, icd::Compression::None, cells.size()}};
}

class MapsAtARunChange : public testing::Test {
 protected:
  MapsAtARunChange() {
    settings_.command_post.scoring = settings_.command_post.mapping = post_.address();
    settings_.command_post.rates.map_hz = settings_.command_post.rates.status_hz = 1000;
  }
  void SetUp() override { restart(); }
  void restart() {
    flow_.reset();
    const auto token = icd::BearerToken::parse("a-token");
    flow_.emplace(loop_, ledger_, settings_, Tokens{.scoring = token, .mapping = token, .all = {*token}},
                  Flow::Folders{folder_.path(), folder_.path()},
                  Flow::Callbacks{.on_changed = [] {}, .on_posted = [](const std::string&) {}});
    flow_->start();
  }
  const dispatch::Run& run() const { return flow_->reports().run(); }
  void receive_status(const RunState& says) {
    post_.says(says);
    next_status();
  }
  void next_status() {
    const auto is_idle = [this] { return !flow_->scoring().channel().busy(); };
    ASSERT_TRUE(loop::turn_until(loop_, is_idle));
    const auto heard = run().heard;
    flow_->on_link_up();
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return run().heard != heard && is_idle(); }));
  }
  void accept(icd::MapUpdate map) {
    bool is_taken = false;
    flow_->begin_map()->accept(std::move(map), sender_,
                               [&](const icd::Checked<void>& said) { is_taken = said.has_value(); });
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return is_taken; }));
  }
  bool all_arrive() {
    return loop::turn_until(loop_, [&] { return flow_->maps().waiting({TrafficKind::Grid, "r1"}) == 0; });
  }
  void map_the_area() {
    accept(part_at(0, kWidth, 50));
    ASSERT_TRUE(all_arrive());
  }
  /// Queues two parts together while a distant one is packed. Returns the number of messages for them.
  int map_both_ends() {
    std::promise<void> let_go;
    const auto until = let_go.get_future().share();
    for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
      flow_->workers().submit(loop::Urgency::OnTheWay, [until] { until.wait(); }, [] {});
    accept(part_at(10'000, 4, 1));
    const int before = post_.maps() + 1;
    accept(part_at(0, 4, 60));
    accept(part_at(kWidth - 4, 4, 61));
    let_go.set_value();
    EXPECT_TRUE(all_arrive());
    return post_.maps() - before;
  }
  /// The Command Post has the area in a running run.
  void begin_with_the_area() {
    receive_status({.clock = 600});
    receive_status({.clock = 601});
    map_the_area();
  }
  void map_both_ends_over(std::uint8_t between) {
    map_both_ends();
    EXPECT_THAT(post_.area(), ElementsAreArray(with_both_ends(between)));
  }
  static Area with_both_ends(std::uint8_t between) {
    Area area(kWidth, between);
    std::fill_n(area.begin(), 4, 60);
    std::fill_n(area.rbegin(), 4, 61);
    return area;
  }

  const intake::Sender sender_{.address = "10.0.0.5", .bytes = 10};
  CommandPostStub post_;
  host::Folder folder_;
  loop::Loop loop_;
  settings::Settings settings_;
  ledger::Ledger ledger_ = std::move(*ledger::Ledger::open(folder_.path()));
  std::optional<Flow> flow_;
};

TEST_F(MapsAtARunChange, KeepAnAreaIfTheClockGoesBack) {
  begin_with_the_area();
  receive_status({.clock = 541});
  ASSERT_EQ(run().number, 2);
  map_both_ends_over(50);
}

TEST_F(MapsAtARunChange, KeepAnAreaIfAnAnswerNamesTheOldRun) {
  receive_status({.clock = 600});
  receive_status({.clock = 601});
  ASSERT_TRUE(flow_->report({.type = "Rope", .position = {1, 2, 3}}, false));
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return run().id == "1"; }));
  map_the_area();
  receive_status({.clock = 541, .left = 13});
  ASSERT_EQ(run().number, 2);
  ASSERT_TRUE(flow_->report({.type = "Rope", .position = {40, 50, 60}}, false));
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return run().number == 1; }));
  map_both_ends_over(50);
}

TEST_F(MapsAtARunChange, KeepAnAreaIfAReportMayHaveBeenGranted) {
  begin_with_the_area();
  receive_status({.clock = 601, .left = 15});
  ASSERT_EQ(run().number, 2);
  map_both_ends_over(50);
}

TEST_F(MapsAtARunChange, KeepAnAreaAfterALongStop) {
  begin_with_the_area();
  flow_.reset();
  auto known = ledger_.runs();
  ASSERT_EQ(known.size(), 1U);
  known.front().heard -= 3000;
  ASSERT_TRUE(ledger_.write(known.front()));
  restart();
  receive_status({.clock = 602});
  ASSERT_EQ(run().number, 2);
  map_both_ends_over(50);
}

TEST_F(MapsAtARunChange, KeepAnAreaSentBeforeANewRunIsDetected) {
  receive_status({.clock = 600});
  receive_status({.clock = 601});
  receive_status({.clock = 602});
  post_.begins_run({.clock = 2, .left = 25, .run = "2"});
  map_the_area();
  next_status();
  ASSERT_EQ(run().number, 2);
  map_both_ends_over(50);
}

TEST_F(MapsAtARunChange, AreStitchedIfOnlyTheOldRunHadTheArea) {
  begin_with_the_area();
  receive_status({.clock = 602});
  receive_status({.clock = 603});
  post_.begins_run({.clock = 2, .left = 25, .run = "2"});
  next_status();
  ASSERT_EQ(run().number, 2);
  EXPECT_EQ(map_both_ends(), 1);
  EXPECT_THAT(post_.area(), ElementsAreArray(with_both_ends(kUnknown)));
}

}  // namespace
}  // namespace adit::forward
