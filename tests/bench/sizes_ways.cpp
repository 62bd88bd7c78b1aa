#include "sizes_ways.hpp"

#include <zlib.h>

#include <algorithm>
#include <ctime>
#include <span>
#include <utility>

#include "codec/gzip.hpp"
#include "pack/pack.hpp"

namespace adit::bench {
namespace {

std::chrono::nanoseconds cpu_now() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

std::size_t by_zlib(const icd::MapUpdate& map, int level) {
  z_stream stream{};
  deflateInit2(&stream, level, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY);
  std::vector<std::uint8_t> piece(icd::ChunkedBytes::kChunk);
  const auto deflate_with = [&](std::span<const std::uint8_t> bytes, int flush) {
    stream.next_in = const_cast<Bytef*>(bytes.data());
    stream.avail_in = static_cast<uInt>(bytes.size());
    do {
      stream.next_out = piece.data();
      stream.avail_out = static_cast<uInt>(piece.size());
      deflate(&stream, flush);
    } while (stream.avail_out == 0);
  };
  for (const auto& chunk : map.data.bytes.chunks()) deflate_with(*chunk, Z_NO_FLUSH);
  deflate_with({}, Z_FINISH);
  const std::size_t size = stream.total_out;
  deflateEnd(&stream);
  return size;
}

PackingWay zlib(int level) {
  return {"zlib " + std::to_string(level), false, false,
          [level](const icd::MapUpdate& map) { return by_zlib(map, level); }};
}

PackingWay libdeflate(int level) {
  return {"libdeflate " + std::to_string(level), level > 9, false, [level](const icd::MapUpdate& map) {
            const std::vector<std::uint8_t> bytes = map.data.bytes.to_vector();
            return codec::gzip(bytes, level, 2 * bytes.size() + 1000)->size();
          }};
}

PackingWay adit(std::string name, const pack::CloudForm& form) {
  return {std::move(name), false, false,
          [form](const icd::MapUpdate& map) { return pack::pack(map, form).data.bytes.size(); }};
}

std::vector<PackingWay> of_others() {
  return {zlib(6), zlib(9), libdeflate(6), libdeflate(12)};
}

}  // namespace

std::vector<PackingWay> ways_for_grids() {
  auto ways = of_others();
  ways.push_back({"zlib's runs, as kept", false, false,
                  [](const icd::MapUpdate& map) { return as_kept(map).data.bytes.size(); }});
  ways.push_back({"Adit, of what is kept", false, true, [](const icd::MapUpdate& map) {
                    return pack::pack_cells(map.data, pack::effort_for(map, {}).effort)->bytes.size();
                  }});
  return ways;
}

std::vector<PackingWay> ways_for_clouds() {
  auto ways = of_others();
  ways.push_back(adit("Adit, as it came", {.is_arranged = false}));
  ways.push_back(adit("Adit, quick", {.effort = pack::Effort::Quick}));
  ways.push_back(adit("Adit, exact", {}));
  ways.push_back(adit("Adit, 1mm", {.unit = pack::kMillimetre}));
  ways.push_back(adit("Adit, 8mm", {.unit = pack::kEightMillimetres}));
  return ways;
}

icd::MapUpdate as_kept(icd::MapUpdate grid) {
  grid.data.bytes = codec::gzip(std::move(grid.data.bytes), codec::GzipStrategy::Runs);
  grid.data.compression = icd::Compression::Gzip;
  return grid;
}

Measured measured(const PackingWay& way, const icd::MapUpdate& map) {
  constexpr int kMostRounds = 5;
  constexpr std::chrono::milliseconds kEnough{300};
  const icd::MapUpdate given = way.is_kept ? as_kept(map) : map;
  Measured best{0, kEnough * 1000};
  std::chrono::nanoseconds all{};
  for (int round = 0; round < kMostRounds && all < kEnough; ++round) {
    const auto began = cpu_now();
    best.bytes = way.pack(given);
    const auto took = cpu_now() - began;
    all += took;
    best.cpu = std::min<std::chrono::duration<double, std::milli>>(best.cpu, took);
  }
  return best;
}

}  // namespace adit::bench
