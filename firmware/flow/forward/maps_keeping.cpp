// The writer stores each map before Adit accepts it, and deletes it later.
#include <algorithm>

#include "forward/maps.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "pack/pack.hpp"

namespace adit::forward {
namespace {

icd::Refusal not_kept() {
  return {icd::Status::ServiceUnavailable, "Adit cannot store this map; send it again later"};
}

/// In this thread, with the file.
icd::Checked<icd::MapUpdate> without_data(icd::MapUpdate map, std::shared_ptr<spool::MapFile> file) {
  map.data = {};
  file.reset();
  return map;
}

icd::Stamp stamp_of(const icd::MapUpdate& map) {
  return map.header().stamp.value_or(0);
}

}  // namespace

/// A full queue accepts replacing maps. If it is full by number alone, it accepts merging maps.
bool Maps::has_room_for(const icd::MapUpdate& update, bool replaces) const {
  const std::size_t waiting = queue_.bytes() + bytes_being_kept_;
  const std::size_t count = queue_.count() + static_cast<std::size_t>(being_kept_);
  if (!replaces && count >= kMostMaps && (count >= kMostWithJoined || !queue_.joins(update))) return false;
  return replaces || waiting == 0 || waiting + update.data.bytes.size() <= settings_.queues.map_bytes;
}

/// With room for a grid that replaces one.
std::shared_ptr<intake::MapArrival> Maps::arrives(MapArrival::Take take) {
  return std::make_shared<MapArrival>(
      while_alive_, spool_, [this] { return queue_.largest_replaceable(); }, std::move(take));
}

void Maps::take(icd::MapUpdate update, std::size_t bytes_received, std::shared_ptr<spool::MapFile> file,
                std::function<void(icd::Checked<void>)> done) {
  const bool replaces = queue_.replaces_any(update);
  const auto refuse = [&](icd::Refusal why) {
    if (file) writer_.submit([file = std::move(file)]() mutable { file.reset(); }, [] {});
    done(std::unexpected(std::move(why)));
  };
  if (!has_room_for(update, replaces)) {
    record_.no_room(traffic_of(update), loop_.wall_now());
    return refuse(
        {icd::Status::TooManyRequests,
         icd::sentence("the queue is full: ", queue_.count() + static_cast<std::size_t>(being_kept_),
                       " maps, ", (queue_.bytes() + bytes_being_kept_) / 1000000,
                       " MB; this map was not accepted, send it again later")});
  }
  if (!is_told(update)) return refuse(not_kept());
  const auto keeping = std::make_shared<Keeping>();
  keeping->bytes_received = bytes_received;
  // Newer grids and whole clouds need room beside the old one.
  const bool is_whole =
      update.is_grid() || queue_.clouds_of(queues::Sender::of(update)) == queues::Clouds::Whole;
  const std::uint64_t of_its_own = is_whole ? update.data.bytes.size() : 0;
  if (!replaces) keeping->spare = std::max<std::uint64_t>(queue_.largest_replaceable(), of_its_own);
  keeping->update = std::move(update);
  keeping->file = std::move(file);
  keep(keeping, [this, done = std::move(done)](Keeping& it) { kept(it, done); });
}

/// Lower numbers for older maps: later processes follow them.
std::uint64_t Maps::next_number(bool again) {
  return again && again_numbers_ < kFirstNumber - 1 ? ++again_numbers_ : ++numbers_;
}

/// By the writer, under the next number, then `told`.
void Maps::keep(const std::shared_ptr<Keeping>& keeping, const std::function<void(Keeping&)>& told) {
  keeping->number = next_number(keeping->again.has_value());
  keeping->size = keeping->update.data.bytes.size();
  keeping->kept = std::unexpected(not_kept());
  writer_.submit(
      [&spool = spool_, keeping] {
        keeping->says_nothing = !keeping->again && pack::has_only_invalid_points(keeping->update);
        keeping->kept = keeping->says_nothing
                            ? without_data(std::move(keeping->update), std::move(keeping->file))
                            : spool.keep(keeping->number, std::move(keeping->update), keeping->spare,
                                         std::move(keeping->file));
      },
      [this, keeping, told] {
        --being_kept_;
        bytes_being_kept_ -= keeping->size;
        told(*keeping);
      });
  ++being_kept_;
  bytes_being_kept_ += keeping->size;
}

/// Queued now; the sender may know.
void Maps::kept(Keeping& keeping, const std::function<void(icd::Checked<void>)>& done) {
  if (keeping.says_nothing) {
    record_.no_valid_point(traffic_of(*keeping.kept), keeping.bytes_received, loop_.wall_now());
    forget({&keeping.number, 1});
    return done({});
  }
  const std::string before = std::exchange(trouble_, keeping.kept ? "" : keeping.kept.error().sentence);
  if (!keeping.kept) {
    if (before.empty()) host::log(host::Level::Error, "cannot store a map", {{"why", trouble_}});
    return done(std::unexpected(std::move(keeping.kept.error())));
  }
  record_.accepted(traffic_of(*keeping.kept), keeping.bytes_received, loop_.wall_now());
  forget(add(keeping.number, std::move(*keeping.kept)));
  done({});
  compare();
  pump();
}

void Maps::restore(spool::Spool::Kept kept) {
  trouble_ = spool_.trouble();
  for (auto& [number, map] : kept) restore(number, std::move(map));
}

void Maps::restore(std::uint64_t number, icd::MapUpdate update) {
  const bool again = number < kFirstNumber;
  std::uint64_t& last = again ? again_numbers_ : numbers_;
  last = std::max(last, number);
  const icd::Stamp stamp = update.header().stamp.value_or(loop_.stamp_now());
  record_.accepted(traffic_of(update), update.data.bytes.size(), time_of(loop_, stamp));
  if (again) {
    forget(queue_.put_back(waiting_again(number, std::move(update), stamp)));
  } else {
    tell_clouds(update);
    queue_.restore(number, std::move(update), loop_.now());
  }
  unread_.insert(number);
  compare();
  pump();
}

/// Returns the numbers of replaced maps.
std::vector<std::uint64_t> Maps::add(std::uint64_t number, icd::MapUpdate update) {
  tell_clouds(update);
  const Traffic traffic = traffic_of(update);
  auto replaced = queue_.add(number, std::move(update), loop_.now());
  record_.replaced(traffic, replaced.size());
  return replaced;
}

void Maps::tell_clouds(const icd::MapUpdate& update) {
  const queues::Clouds clouds = queue_.clouds_of(queues::Sender::of(update));
  if (clouds != queues::Clouds::Auto) record_.clouds_are(traffic_of(update), clouds);
}

void Maps::forget(std::span<const std::uint64_t> numbers) {
  if (numbers.empty()) return;
  writer_.submit(
      [&spool = spool_, gone = std::vector(numbers.begin(), numbers.end())] {
        for (const std::uint64_t number : gone) spool.forget(number);
      },
      [] {});
}

/// It must not follow a newer map that contains it.
void Maps::send_again(icd::MapUpdate update, std::function<bool(bool kept)> done) {
  const icd::Stamp again = stamp_of(update);
  const queues::QueuedMap back = waiting_again(again_numbers_ + 1, update, again);
  if (queue_.is_replaced(back) || is_said_by_what_goes(back)) {
    done(true);
    return;
  }
  const auto keeping = std::make_shared<Keeping>();
  keeping->again = again;
  update.header().stamp = loop_.stamp_now();
  keeping->update = std::move(update);
  keep(keeping, [this, done = std::move(done)](Keeping& it) { kept_again(it, done); });
}

void Maps::kept_again(Keeping& keeping, const std::function<bool(bool kept)>& done) {
  const bool is_wanted = done(keeping.kept.has_value());
  if (!keeping.kept) {
    return host::log(host::Level::Error, "cannot send a rejected map again",
                     {{"why", keeping.kept.error().sentence}});
  }
  queues::QueuedMap back = waiting_again(keeping.number, std::move(*keeping.kept), *keeping.again);
  if (!is_wanted || is_said_by_what_goes(back)) return forget({&keeping.number, 1});
  unread_.insert(keeping.number);  // perhaps rejected by an earlier process
  forget(queue_.put_back(std::move(back)));
  pump();
}

queues::QueuedMap Maps::waiting_again(std::uint64_t number, icd::MapUpdate update, icd::Stamp again) const {
  return {
      .map = std::move(update), .accepted = loop_.now(), .updates = {number}, .alone = true, .again = again};
}

}  // namespace adit::forward
