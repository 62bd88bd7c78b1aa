// How small maps become, and in what time: each map by each way, in one run, as Markdown. Run by `sizes`.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "sizes_maps.hpp"
#include "sizes_ways.hpp"

namespace adit::bench {
namespace {

/// In the order of the ways: CPU is set beside the first, bytes beside the second.
constexpr std::size_t kUsual = 0, kBest = 1;

void print_head(const char* what, const std::vector<PackingWay>& ways, const PackingWay& beside) {
  std::printf("\n**%s**: bytes beside %s (CPU beside %s)\n\n| map | MB | bytes by %s | ms by %s |", what,
              beside.name.c_str(), ways[kUsual].name.c_str(), beside.name.c_str(), ways[kUsual].name.c_str());
  for (const PackingWay& way : ways) std::printf(" %s |", way.name.c_str());
  std::printf("\n| --- | --- | --- | --- |");
  for (std::size_t i = 0; i < ways.size(); ++i) std::printf(" --- |");
  std::printf("\n");
}

void print_row(const SizedMap& map, const std::vector<PackingWay>& ways, std::size_t beside) {
  std::vector<Measured> all;
  for (const PackingWay& way : ways) all.push_back(measured(way, map.update));
  const double bytes = static_cast<double>(all[beside].bytes), ms = all[kUsual].cpu.count();
  std::printf("| %s | %.2f | %.0f | %.2f |", map.name.c_str(),
              static_cast<double>(map.update.data.raw_size) / 1e6, bytes, ms);
  for (const Measured& each : all) {
    std::printf(" %.3f (%.2f) |", static_cast<double>(each.bytes) / bytes, each.cpu.count() / ms);
  }
  std::printf("\n");
  std::fflush(stdout);
}

void print_table(const char* what, const std::vector<SizedMap>& maps, bool are_grids, bool is_short,
                 std::size_t beside) {
  std::vector<PackingWay> ways = are_grids ? ways_for_grids() : ways_for_clouds();
  if (is_short) std::erase_if(ways, [](const PackingWay& way) { return way.is_slow; });
  print_head(what, ways, ways[beside]);
  for (const SizedMap& map : maps) {
    if (map.update.is_grid() == are_grids) print_row(map, ways, beside);
  }
}

}  // namespace
}  // namespace adit::bench

int main(int argc, char** argv) {
  using namespace adit::bench;
  bool is_short = false;
  std::uint64_t seed = 0;
  for (int i = 1; i < argc; ++i) {
    const std::string_view option = argv[i];
    if (option == "--short") {
      is_short = true;
    } else if (option == "--seed" && i + 1 < argc) {
      seed = std::strtoull(argv[++i], nullptr, 10);
    } else {
      std::fprintf(stderr, "Usage: sizes [--short] [--seed N]\n");
      return 2;
    }
  }
  const char* const folder = std::getenv("ADIT_MAPS");
  auto maps = recorded_maps(folder == nullptr ? "" : folder);
  if (!maps) {
    std::fprintf(stderr, "sizes: %s\n", maps.error().c_str());
    return 1;
  }
  if (maps->empty()) std::printf("ADIT_MAPS names no folder of recorded maps: generated ones alone\n");
  for (SizedMap& map : generated_grids(is_short, seed)) maps->push_back(std::move(map));
  for (SizedMap& map : generated_clouds(is_short, seed)) maps->push_back(std::move(map));
  print_table("grids", *maps, true, is_short, kBest);
  print_table("clouds", *maps, false, is_short, kUsual);
  return 0;
}
