#include "forward/map_arrival.hpp"

#include <utility>

#include "icd/refuse.hpp"

namespace adit::forward {

MapArrival::MapArrival(std::weak_ptr<loop::Writer> writer, spool::Spool& spool,
                       std::function<std::uint64_t()> spare, Take take)
    : writer_(std::move(writer)), spool_(spool), spare_(std::move(spare)), take_(std::move(take)) {}

/// The writer removes an unnamed file. The loop does not wait.
MapArrival::~MapArrival() {
  const auto writer = writer_.lock();
  if (!writer || !stored_->file) return;
  writer->submit([stored = std::move(stored_)]() mutable { stored->file.reset(); }, [] {});
}

void MapArrival::store(icd::ChunkedBytes bytes, std::function<void(icd::ChunkedBytes left)> done) {
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

icd::Checked<icd::ChunkedBytes> MapArrival::stored() {
  if (!stored_->file || stored_->file->stored_bytes() == 0) return {};
  icd::ChunkedBytes data = stored_->file->stored();
  if (data.empty())
    return icd::refuse(icd::Status::ServiceUnavailable, "Adit cannot store this map; send it again later");
  return data;
}

void MapArrival::take(icd::MapUpdate update, const intake::Sender& sender,
                      std::function<void(icd::Checked<void>)> done) {
  take_(std::move(update), sender, std::exchange(stored_->file, nullptr), std::move(done));
}

}  // namespace adit::forward
