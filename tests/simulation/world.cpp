#include "simulation/world.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "simulation/heap.hpp"
#include "simulation/messages.hpp"

namespace adit::simulation {
namespace {

constexpr Instant kBeginning{std::chrono::seconds{1000}};
/// Limits of one process, including the simulated world: total bytes, and bytes of one request.
constexpr std::size_t kMostHeap = 24u << 20, kMostAtOnce = 8u << 20;
World* the_world = nullptr;

}  // namespace

World::World(std::uint64_t seed, Omissions without)
    : seed_(seed),
      without_(std::move(without)),
      has_large_maps_(random("large maps").chance(0.05)),
      has_large_grids_(has_large_maps_ && random("large grids").chance(0.3)),
      now_(kBeginning),
      network_(*this),
      door_(*this),
      disk_(*this) {
  the_world = this;
}

World::~World() {
  the_world = nullptr;
}

World& World::current() {
  assert(the_world != nullptr);
  return *the_world;
}

double World::time() const {
  return std::chrono::duration<double>(now_ - kBeginning).count();
}

void World::at(Instant when, std::function<void()> happen) {
  planned_.push({std::max(when, now_), ++order_, std::move(happen)});
}

bool World::step() {
  if (planned_.empty()) return false;
  auto happen = std::move(const_cast<Planned&>(planned_.top()).happen);
  now_ = std::max(now_, planned_.top().at);
  planned_.pop();
  ++steps_;
  happen();
  return true;
}

void World::run_for(Duration duration) {
  const Instant end = now_ + duration;
  while (!planned_.empty() && planned_.top().at <= end) {
    step();
    while (descriptors_.dispatch(Descriptors::Whose::All)) {
    }
  }
  now_ = std::max(now_, end);
}

void World::set_clock(double seconds_ahead) {
  clock_ahead_ = seconds_ahead;
  note({.kind = Kind::ClockSet, .what = "", .who = "", .stamp = seconds_ahead});
}

bool World::omits(const std::string& actor) {
  return without_.has(actor, ++actions_[actor]);
}

void World::stand_still(Duration duration) {
  if (in_worker_) {
    worker_waited_ += duration;
    return;
  }
  if (now_ < stands_until_) return;  // it stands still already
  note({.actor = Actor::Disk,
        .kind = Kind::Slow,
        .what = "",
        .who = "",
        .stamp = std::chrono::duration<double>(duration).count()});
  const Instant end = stands_until_ = now_ + duration;
  while (!dead_ && !planned_.empty() && planned_.top().at < end) {
    step();
    while (!dead_ && descriptors_.dispatch(Descriptors::Whose::Others)) {
    }
  }
  if (!dead_) now_ = std::max(now_, end);
  stands_until_ = now_;
}

void World::when_moving(std::function<void()> happen) {
  if (now_ >= stands_until_) return happen();
  at(stands_until_, [this, happen = std::move(happen)]() mutable { when_moving(std::move(happen)); });
}

Duration World::in_worker(const std::function<void()>& work) {
  worker_waited_ = {};
  in_worker_ = true;
  work();
  in_worker_ = false;
  return worker_waited_;
}

void World::note(Event event) {
  if (crossings_after_report_ && event.kind == Kind::Left && event.what == kReports)
    crossings_left_ = 1 + *std::exchange(crossings_after_report_, std::nullopt);
  event.at = time();
  event.process = process_;
  history_.note(std::move(event));
}

void World::begin_process(bool again) {
  ++process_;
  dead_ = false;
  if (!again) {
    dies_ = nullptr;
    crossings_after_report_.reset();
  }
  disk_.calls().process_begins();
  note({.kind = Kind::Begins, .what = "aditd", .who = "", .serial = process_});
  heap_at_begin_ = heap();
  most_wanted();
}

void World::look_at_heap() {
  const std::size_t now = heap(), taken = now - std::min(now, heap_at_begin_), wanted = most_wanted();
  if (taken <= kMostHeap && wanted <= kMostAtOnce) return;
  note({.kind = Kind::Forbidden,
        .what = kTooMuch,
        .who = "",
        .text = "memory: " + std::to_string(taken) + " bytes, " + std::to_string(wanted) + " at once"});
}

void World::end_process() {
  look_at_heap();
  dead_ = true;
  network_.cut();
  door_.cut();
  disk_.let_go();
  note({.kind = Kind::Ended, .what = "aditd", .who = "", .serial = process_});
}

void World::die_after(std::uint64_t crossings, How how, std::function<void()> dies) {
  how_ = how;
  crossings_after_report_.reset();
  crossings_left_ = crossings;
  dies_ = std::move(dies);
  if (crossings == 0) die();
}

void World::die_after_report(std::uint64_t crossings, How how, std::function<void()> dies) {
  how_ = how;
  crossings_after_report_ = crossings;
  dies_ = std::move(dies);
}

void World::crossing() {
  if (dead_ || !dies_ || crossings_after_report_) return;
  if (crossings_left_ == 0 || --crossings_left_ == 0) die();
}

void World::die() {
  const auto dies = std::exchange(dies_, nullptr);
  note({.kind = Kind::Dies, .what = "aditd", .who = "", .serial = process_});
  dead_ = true;
  how_ == How::PowerCut ? network_.vanish() : network_.cut();
  door_.cut();
  disk_.let_go();
  dies();
}

}  // namespace adit::simulation
