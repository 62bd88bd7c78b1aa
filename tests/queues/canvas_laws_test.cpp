// A window that rolls with its robot is sent with known cells in the gaps between its places. The Command
// Post must finally have the posted cells, whatever the outcome of each try.
#include <gmock/gmock.h>

#include <bitset>
#include <random>
#include <vector>

#include "queues/map_queue.hpp"
#include "queues/maps.hpp"
#include "queues/packing.hpp"

namespace adit::queues {
namespace {

constexpr int kSide = 400;  // cells of the world; (0, 0) is its centre
constexpr int kWindow = 14;
constexpr double kCell = 0.05;

/// The world's cells at a server.
struct World {
  std::vector<std::uint8_t> cells = std::vector<std::uint8_t>(std::size_t{kSide} * kSide, icd::kUnknownCell);
  bool overlays = false;  // unknown cells overwrite no cell

  void empty() { std::ranges::fill(cells, icd::kUnknownCell); }
  void put(const icd::OccupancyGrid& grid, const std::vector<std::uint8_t>& values) {
    const auto at = *cells_in(queues::grid(-kSide / 2 * kCell, -kSide / 2 * kCell, 1, 1), grid);
    auto value = values.begin();
    for (std::int64_t y = at.y; y < at.top(); ++y) {
      for (std::int64_t x = at.x; x < at.right(); ++x, ++value) {
        if (!overlays || *value != icd::kUnknownCell) cells[static_cast<std::size_t>(y * kSide + x)] = *value;
      }
    }
  }
};

class CanvasLaws : public testing::TestWithParam<std::uint64_t> {
 protected:
  void run(int steps) {
    queue_.canvases() = Canvases{kMostTiles};
    for (int step = 0; step < steps; ++step) {
      const int what = pick(400);
      if (what < 250) post();
      if (what >= 250 && what < 376) send();
      if (what >= 376 && what < 396) ask_or_read_status();
      if (what == 396) change_run();
      if (what == 397) restart();
      if (what == 398) begin_run();
      if (what == 399) x_ = pick(200) - 100, y_ = pick(200) - 100;  // it is carried away
    }
    while (queue_.count() > 0 || following_) send();
  }

  /// Posts the moved window, sometimes another patch.
  void post() {
    if (pick(25) == 0) towards_x_ = pick(9) - 4, towards_y_ = pick(9) - 4;
    x_ = std::clamp(x_ + towards_x_, -150, 130), y_ = std::clamp(y_ + towards_y_, -150, 130);
    const bool is_patch = pick(12) == 0;
    const auto side = static_cast<std::uint32_t>(is_patch ? 1 + pick(40) : kWindow);
    icd::MapUpdate map = grid_update("R1", grid(x_ * kCell, y_ * kCell, side, side));
    std::vector<std::uint8_t> values(map.data.raw_size);
    for (auto& value : values)
      value = pick(4) == 0 ? icd::kUnknownCell : static_cast<std::uint8_t>(pick(101));
    map.data = {icd::ChunkedBytes{values}, icd::Compression::None, values.size()};
    posted_.put(std::get<icd::OccupancyGrid>(map.msg), values);
    note_posted(std::get<icd::OccupancyGrid>(map.msg), values);
    if (const auto grows = queue_.canvases().grows(map)) {
      queue_.canvases().on_grown(*grows);
      extents_[grows->first] = grows->second;
    }
    kept_[++number_] = map;
    forget(queue_.add(number_, std::move(map), at(static_cast<double>(number_))));
  }

  void note_posted(const icd::OccupancyGrid& grid, const std::vector<std::uint8_t>& values) {
    const auto at = *cells_in(queues::grid(-kSide / 2 * kCell, -kSide / 2 * kCell, 1, 1), grid);
    auto value = values.begin();
    for (std::int64_t y = at.y; y < at.top(); ++y) {
      for (std::int64_t x = at.x; x < at.right(); ++x)
        ever_posted_[static_cast<std::size_t>(y * kSide + x)].set(*value++);
    }
  }

  struct Sent {
    QueuedMap waiting;
    std::vector<std::uint8_t> cells;
    int run = 0;  // the run that was known
  };
  std::optional<Sent> take() {
    auto next = queue_.pop();
    if (!next) return {};
    auto cells = packed_of(queue_, *next);
    gaps_ += next->has_gaps ? 1 : 0;
    return Sent{*std::move(next), std::move(cells), known_run_};
  }

  /// Packs the next map while one is in flight, whose delivery may be unknown.
  void send() {
    auto sent = following_ ? std::exchange(following_, {}) : take();
    if (!sent) return;
    if (pick(3) == 0) following_ = take();
    under_way_ = &*sent;
    while (pick(3) == 0) post();
    while (pick(4) == 0) ask_or_read_status();
    under_way_ = nullptr;
    const int what = pick(20);
    if (what > 3) {
      deliver(*sent);
      forget(sent->waiting.updates);
      return;
    }
    if (what % 2 == 0) deliver(*sent);  // without an answer
    if (following_) forget(queue_.put_back(std::exchange(following_, {})->waiting));
    if (what == 3) ++sent->waiting.trial.failures;
    if (what == 1 && !sent->waiting.parts.empty()) return queue_.put_back_single(std::move(sent->waiting));
    forget(queue_.put_back(std::move(sent->waiting)));
  }

  void deliver(const Sent& sent) {
    const auto& grid = std::get<icd::OccupancyGrid>(sent.waiting.map.msg);
    if (sent.waiting.has_gaps) check_gaps(sent, grid);
    overwriting_.put(grid, sent.cells);
    overlaying_.put(grid, sent.cells);
  }

  /// Checks that no cell that the server knows becomes unknown.
  void check_gaps(const Sent& sent, const icd::OccupancyGrid& grid) {
    std::vector<std::uint8_t> is_posted(sent.cells.size(), 0);
    for (const QueuedMap& part : sent.waiting.parts) {
      const auto its = *cells_in(grid, std::get<icd::OccupancyGrid>(part.map.msg));
      for (std::int64_t y = its.y; y < its.top(); ++y)
        std::fill_n(is_posted.begin() + y * grid.width + its.x, its.width, 1);
    }
    const auto at = *cells_in(queues::grid(-kSide / 2 * kCell, -kSide / 2 * kCell, 1, 1), grid);
    for (std::size_t i = 0; i < sent.cells.size(); ++i) {
      if (is_posted[i] != 0) continue;
      const auto x = at.x + static_cast<std::int64_t>(i % grid.width);
      const auto y = at.y + static_cast<std::int64_t>(i / grid.width);
      const auto place = static_cast<std::size_t>(y * kSide + x);
      if (sent.cells[i] == icd::kUnknownCell && overwriting_.cells[place] != icd::kUnknownCell) ++blanked_;
      if (sent.run != run_) is_of_earlier_run_[place] = true;
    }
  }

  /// The server's map is empty. The queue notices the run with the next status. Queued maps belong to the
  /// new run: their cells are the newest.
  void begin_run() {
    ++run_;
    std::fill(is_of_earlier_run_.begin(), is_of_earlier_run_.end(), false);
    for (World* world : {&posted_, &overwriting_, &overlaying_}) world->empty();
    std::ranges::fill(ever_posted_, std::bitset<256>{});
    for (const auto& [number, map] : kept_) {
      const auto& grid = std::get<icd::OccupancyGrid>(map.msg);
      const auto bytes = *map.data.bytes.chunks().front();
      const std::vector<std::uint8_t> values(bytes.begin(), bytes.end());
      posted_.put(grid, values);
      note_posted(grid, values);
    }
  }

  /// Asks for a status, or reads the answer to an earlier request.
  void ask_or_read_status() {
    if (!pending_status_) {
      pending_status_ = run_;
      return;
    }
    const int status = *std::exchange(pending_status_, {});
    if (status == known_run_) {
      std::vector<const icd::MapUpdate*> maps;
      if (under_way_ != nullptr) maps.push_back(&under_way_->waiting.map);
      if (following_) maps.push_back(&following_->waiting.map);
      return queue_.canvases().on_status(maps);
    }
    known_run_ = status;
    if (following_) forget(queue_.put_back(std::exchange(following_, {})->waiting));
    queue_.canvases().begin_run();
  }

  /// The queue takes the run for another one that may be the same. It is the same.
  void change_run() {
    if (following_) forget(queue_.put_back(std::exchange(following_, {})->waiting));
    queue_.canvases().change_run();
  }

  /// The next process has the queued maps and knows the sent areas.
  void restart() {
    following_.reset();
    pending_status_.reset();
    queue_ = MapQueue{0};
    queue_.canvases() = Canvases{kMostTiles};
    queue_.canvases().restore(extents_);
    const auto kept = kept_;
    for (const auto& [number, map] : kept) forget(queue_.add(number, map, at(static_cast<double>(number))));
  }

  void forget(const ReplacedMaps& replaced) { forget(replaced.numbers); }
  void forget(const std::vector<std::uint64_t>& numbers) {
    for (const std::uint64_t number : numbers) kept_.erase(number);
  }
  int pick(int below) { return std::uniform_int_distribution{0, below - 1}(random_); }

  static constexpr std::size_t kMostTiles = 12;
  std::mt19937_64 random_{GetParam()};
  MapQueue queue_{0};
  std::map<std::uint64_t, icd::MapUpdate> kept_;
  Canvases::PostedAreas extents_;
  std::optional<Sent> following_;
  const Sent* under_way_ = nullptr;
  int run_ = 1, known_run_ = 1, blanked_ = 0;
  std::optional<int> pending_status_;  // the run at the time of the pending status request
  std::uint64_t number_ = 0;
  int x_ = 0, y_ = 0, towards_x_ = 2, towards_y_ = 3, gaps_ = 0;
  std::vector<std::bitset<256>> ever_posted_ = std::vector<std::bitset<256>>(std::size_t{kSide} * kSide);
  std::vector<bool> is_of_earlier_run_ = std::vector<bool>(std::size_t{kSide} * kSide);
  World posted_, overwriting_, overlaying_{.overlays = true};
};

/// Until another run is noticed, gaps are filled with the cells of the run before.
TEST_P(CanvasLaws, ServerHasTheNewestValueOfEachPostedCell) {
  run(1000);
  EXPECT_GT(gaps_, 3);
  EXPECT_EQ(blanked_, 0) << "known cells became unknown";
  for (std::size_t i = 0; i < posted_.cells.size(); ++i) {
    const bool may_be_older = is_of_earlier_run_[i];
    if (may_be_older && ever_posted_[i].none()) continue;
    const std::uint8_t newest = posted_.cells[i], has = overlaying_.cells[i];
    ASSERT_EQ(overwriting_.cells[i], newest) << "cell " << i << ": differs on an overwriting server";
    const bool is_right =
        newest != icd::kUnknownCell ? has == newest : has == icd::kUnknownCell || ever_posted_[i].test(has);
    ASSERT_TRUE(is_right || may_be_older)
        << "cell " << i << ": " << int{has} << " on an overlaying server, not " << int{newest};
  }
}

INSTANTIATE_TEST_SUITE_P(Courses, CanvasLaws, testing::Range(std::uint64_t{1}, std::uint64_t{5}));

}  // namespace
}  // namespace adit::queues
