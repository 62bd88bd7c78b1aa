#include "forward/map_store.hpp"

#include <algorithm>
#include <utility>

#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "pack/pack.hpp"

namespace adit::forward {

SpooledMapArrival::SpooledMapArrival(std::weak_ptr<loop::Writer> writer, spool::Spool& spool,
                                     std::function<std::uint64_t()> spare, Accept take)
    : writer_(std::move(writer)), spool_(spool), spare_(std::move(spare)), take_(std::move(take)) {}

/// The writer removes an unnamed file. The loop does not wait.
SpooledMapArrival::~SpooledMapArrival() {
  const auto writer = writer_.lock();
  if (!writer || !stored_->file) return;
  writer->submit([stored = std::move(stored_)]() mutable { stored->file.reset(); }, [] {});
}

void SpooledMapArrival::store(icd::ChunkedBytes bytes, std::function<void(icd::ChunkedBytes left)> done) {
  const auto writer = writer_.lock();
  if (!writer) return;  // the gateway has ended
  const auto held = std::make_shared<icd::ChunkedBytes>(std::move(bytes));
  writer->submit(
      [&spool = spool_, stored = stored_, held, spare = spare_()] {
        const std::uint64_t taken = (stored->file ? stored->file->stored_bytes() : 0) + held->size();
        if (!spool.has_room(held->size() + taken + spare)) return;
        if (!stored->file) stored->file = spool.begin();
        (void)stored->file->append(*held);
      },
      [held, done = std::move(done)] { done(std::move(*held)); });
}

icd::Checked<icd::ChunkedBytes> SpooledMapArrival::stored_bytes() {
  if (!stored_->file || stored_->file->stored_bytes() == 0) return {};
  icd::ChunkedBytes data = stored_->file->mapped_bytes();
  if (data.empty()) return std::unexpected(storage_refusal());
  return data;
}

void SpooledMapArrival::accept(icd::MapUpdate update, const intake::Sender& sender,
                               std::function<void(icd::Checked<void>)> done) {
  take_(std::move(update), sender, std::exchange(stored_->file, nullptr), std::move(done));
}

namespace {

/// In this thread, with the file.
icd::Checked<icd::MapUpdate> strip_data(icd::MapUpdate map, std::shared_ptr<spool::MapFile> file) {
  map.data = {};
  file.reset();
  return map;
}

}  // namespace

icd::Refusal storage_refusal() {
  return {icd::Status::ServiceUnavailable, "Adit cannot store this map; send it again later"};
}

MapStore::MapStore(loop::Writer& writer, spool::Spool& spool)
    : writer_(writer),
      while_alive_(&writer, [](loop::Writer*) {}),
      spool_(spool),
      trouble_(spool.trouble()) {}

std::shared_ptr<intake::MapArrival> MapStore::begin_map(std::function<std::uint64_t()> spare,
                                                        SpooledMapArrival::Accept take) {
  return std::make_shared<SpooledMapArrival>(while_alive_, spool_, std::move(spare), std::move(take));
}

void MapStore::store(icd::MapUpdate update, std::shared_ptr<spool::MapFile> file, std::uint64_t spare,
                     bool again, std::function<void(StoredMap& stored)> done,
                     std::optional<icd::GridBounds> bounds) {
  /// The writer's until it is stored.
  struct Job {
    icd::MapUpdate update;
    std::shared_ptr<spool::MapFile> file;
    std::optional<icd::GridBounds> bounds;
    StoredMap stored;
  };
  const std::size_t size = update.data.bytes.size();
  const auto job = std::make_shared<Job>(Job{std::move(update), std::move(file), bounds, {}});
  // Lower numbers for older maps: later processes follow them.
  job->stored.number = again && again_numbers_ < kFirstNumber - 1 ? ++again_numbers_ : ++numbers_;
  job->stored.map = std::unexpected(storage_refusal());
  writer_.submit(
      [&spool = spool_, job, spare, again] {
        StoredMap& stored = job->stored;
        stored.has_no_valid_point = !again && pack::has_only_invalid_points(job->update);
        stored.map = stored.has_no_valid_point
                         ? strip_data(std::move(job->update), std::move(job->file))
                         : spool.keep(stored.number, std::move(job->update), spare, std::move(job->file));
        if (!stored.map || !job->bounds || spool.keep_bounds(stored.number, *job->bounds)) return;
        spool.forget(stored.number);
        stored.map = std::unexpected(storage_refusal());
      },
      [this, job, size, again, done = std::move(done)] {
        --count_;
        bytes_ -= size;
        StoredMap& stored = job->stored;
        if (!again && !stored.has_no_valid_point) {
          const std::string before = std::exchange(trouble_, stored.map ? "" : stored.map.error().sentence);
          if (!stored.map && before.empty())
            host::log(host::Level::Error, "cannot store a map", {{"why", trouble_}});
        }
        done(stored);
      });
  ++count_;
  bytes_ += size;
}

void MapStore::discard(std::shared_ptr<spool::MapFile> file) {
  if (file) writer_.submit([file = std::move(file)]() mutable { file.reset(); }, [] {});
}

void MapStore::forget(std::span<const std::uint64_t> numbers) {
  forget(queues::ReplacedMaps{.numbers = {numbers.begin(), numbers.end()}});
}

void MapStore::forget(queues::ReplacedMaps replaced) {
  if (replaced.numbers.empty() && !replaced.bounds) return;
  spool_.forget_ends(replaced.numbers);
  writer_.submit(
      [&spool = spool_, replaced = std::move(replaced)] {
        const auto& bounds = replaced.bounds;
        if (bounds && !spool.keep_bounds(bounds->first, bounds->second)) return;
        for (const std::uint64_t number : replaced.numbers) spool.forget(number);
      },
      [] {});
}

void MapStore::set_aside(std::vector<DamagedMap> damaged) {
  for (const DamagedMap& each : damaged) unchecked_.erase(each.number);
  writer_.submit(
      [&spool = spool_, damaged = std::move(damaged)] {
        for (const DamagedMap& each : damaged) spool.set_aside(each.number, each.why);
      },
      [] {});
}

bool MapStore::adopt(std::uint64_t number) {
  const bool again = number < kFirstNumber;
  std::uint64_t& last = again ? again_numbers_ : numbers_;
  last = std::max(last, number);
  mark_unchecked(number);
  return again;
}

std::vector<std::uint64_t> MapStore::begin_work(const queues::QueuedMap& waiting) {
  std::vector<std::uint64_t> numbers;
  queues::add_own_numbers(numbers, waiting);
  spool_.begin_work(numbers);
  std::erase_if(numbers, [this](std::uint64_t number) { return !unchecked_.contains(number); });
  return numbers;
}

void MapStore::end_work(bool are_packed, std::span<const std::uint64_t> checked) {
  spool_.end_work(are_packed);
  if (!are_packed) return;
  for (const std::uint64_t number : checked) unchecked_.erase(number);
}

}  // namespace adit::forward
