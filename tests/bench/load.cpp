/// The load of tests/bench: the same messages by several ways to one Command Post, in turns, and the figures.

#include <array>
#include <cstdio>
#include <functional>
#include <thread>

#include "client.hpp"
#include "command_line/answer.hpp"
#include "figures.hpp"
#include "machine.hpp"
#include "options.hpp"

namespace {

using namespace adit::bench;  // NOLINT(google-build-using-namespace): a program of its own

/// One way and its client.
struct Lane {
  Way way;
  Client client;
  Path path;
};

using Took = std::expected<Clock::duration, std::string>;

/// One way to flush and how long it took.
struct FlushTimes {
  const char* name;
  Took (FlushProbe::*flush)();
  std::vector<Clock::duration> took;
};

/// All ways, and the disk's flushes, have their turns within a second, so that what else the machine does is
/// shared by all.
class Race {
 public:
  static std::expected<Race, std::string> prepare(const Options& options) {
    auto probe = FlushProbe::begin(options.flush);
    if (!probe) return std::unexpected(probe.error());
    Race race(options, *std::move(probe));
    for (const Way& way : options.ways) {
      auto client = Client::connect(way.port, options.token, options.what);
      if (!client) return std::unexpected(way.name + ": " + client.error());
      race.lanes_.push_back({way, *std::move(client), {.name = way.name, .took = {}, .cpu = {}}});
    }
    return race;
  }

  /// A first round that does not count: connections are made, pages are touched.
  std::expected<void, std::string> run() {
    if (auto warm = round(); !warm) return warm;
    for (FlushTimes& flushes : flushes_) flushes.took.clear();
    for (Lane& lane : lanes_) lane.path = {.name = lane.way.name, .took = {}, .cpu = {}};
    const Clock::time_point end = Clock::now() + options_.most;
    while (lanes_.front().path.took.size() < options_.messages && Clock::now() < end)
      if (auto done = round(); !done) return done;
    return {};
  }

  std::vector<Path> paths() const {
    std::vector<Path> paths;
    paths.reserve(lanes_.size());
    for (const Lane& lane : lanes_) paths.push_back(lane.path);
    return paths;
  }
  std::string flush_lines() const {
    std::string lines;
    for (const FlushTimes& flushes : flushes_) lines += flush_line(flushes.name, flushes.took);
    return lines;
  }

 private:
  Race(const Options& options, FlushProbe probe) : options_(options), probe_(std::move(probe)) {}

  /// `options.block` times, `options.pace` apart.
  std::expected<void, std::string> block(const std::function<Took()>& measure,
                                         std::vector<Clock::duration>& times) const {
    for (std::size_t i = 0; i < options_.block; ++i) {
      const Clock::time_point next = Clock::now() + options_.pace;
      const Took took = measure();
      if (!took) return std::unexpected(took.error());
      times.push_back(*took);
      std::this_thread::sleep_until(next);
    }
    return {};
  }

  std::expected<void, std::string> round() {
    for (Lane& lane : lanes_) {
      const auto before = cpu_time(lane.way.process);
      const auto done = block([&] { return lane.client.post(number_++); }, lane.path.took);
      if (!done) return std::unexpected(lane.way.name + ": " + done.error());
      lane.path.cpu += cpu_time(lane.way.process) - before;
    }
    for (FlushTimes& flushes : flushes_)
      if (auto done = block([&] { return (probe_.*flushes.flush)(); }, flushes.took); !done) return done;
    return {};
  }

  Options options_;
  FlushProbe probe_;
  std::vector<Lane> lanes_;
  std::array<FlushTimes, 2> flushes_ = {FlushTimes{"flush, grown", &FlushProbe::append, {}},
                                        FlushTimes{"flush, in place", &FlushProbe::overwrite, {}}};
  std::uint64_t number_ = 0;  // of the next message
};

int fail(const std::string& why) {
  (void)std::fprintf(stderr, "adit_bench_load: %s\n", why.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  const auto options = parse_options({argv + 1, argv + argc});
  if (const auto exit = adit::command_line::answer(command_line_of, "", options)) return *exit;
  auto race = Race::prepare(*options);
  if (!race) return fail(race.error());
  if (const auto ran = race->run(); !ran) return fail(ran.error());
  const std::vector<Path> paths = race->paths();
  std::printf("%zu messages each way, by turns of %zu, one each %lld ms\n%s%s\n%s%s",
              paths.front().took.size(), options->block, static_cast<long long>(options->pace.count()),
              table(paths).c_str(), race->flush_lines().c_str(),
              options->what == Kind::Reports ? comparison(paths, "adit").c_str() : "",
              cpu_comparison(paths, "adit").c_str());
  return 0;
}
