// Serves the page with a scene of scenes.hpp to a browser: `adit_page_scenes PORT [SCENE
// [first-start|set-up-open]]`. The passwords are FakeKeys'; the token is "team-1". Each line on standard
// input is the name of the next scene, or after "say " the next log record. The program ends at the end of
// the input.
#include <sys/epoll.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include "api/api.hpp"
#include "api/counted_map.hpp"
#include "api/fake_box.hpp"
#include "api/fake_clock.hpp"
#include "api/fake_kept_runs.hpp"
#include "api/fake_keys.hpp"
#include "api/fake_network.hpp"
#include "api/fake_setup.hpp"
#include "api/map_scene.hpp"
#include "api/no_finer_map.hpp"
#include "api/played.hpp"
#include "api/played_certificate.hpp"
#include "api/played_spare.hpp"
#include "api/played_updates.hpp"
#include "api/scenes.hpp"

namespace adit::api {
namespace {

class Stage final : public Source, public Operator, public GatewayControl {
 public:
  Stage(loop::Loop& loop, std::string name) : loop_(loop), began_(loop.wall_now()), name_(std::move(name)) {
    draw_scene(map_, began_);
  }

  RunView view() override { return played(); }
  RunView played() const {
    const Time now = loop_.wall_now();
    RunView view = *scene(name_, now, now - began_);
    view.map_version = map().version();
    view.marker_version = markers(0).version;
    if (now < identify_until_) {
      view.identify_until = identify_until_;
      for (LightRow& light : view.lights) light.pattern = "twice";
    }
    played_.apply(view);
    return view;
  }

  std::vector<facts::ReportRow> reports(std::int64_t after, std::size_t most) const override {
    auto rows = played().reports;
    return rows_after({rows.rbegin(), rows.rend()}, after, most);
  }
  ReportCounts report_counts() const override { return counts_of(played().reports); }
  std::optional<ReportDetail> report(std::int64_t number) const override {
    const auto rows = played().reports;
    const auto row = std::ranges::find(rows, number, &facts::ReportRow::number);
    if (row == rows.end()) return {};
    return ReportDetail{*row, {{row->received, "received", ""}, {row->changed, row->state, row->note}}, {}};
  }
  std::expected<std::int64_t, std::string> decide(std::int64_t number, Action action) override {
    return played_.decide(played(), number, action);
  }
  std::expected<std::int64_t, std::string> report(const icd::ArtifactReport& report, bool resubmit) override {
    return played_.report(played(), report, resubmit);
  }
  std::expected<std::int64_t, std::string> correct(std::int64_t number,
                                                   const icd::ArtifactReport& to) override {
    return played_.correct(played(), number, to);
  }
  std::expected<void, std::string> change_rejected(std::uint64_t number, RejectedAction) override {
    return played_.rejected(played(), number);
  }
  std::expected<void, std::string> acknowledge(const std::string& id) override {
    return played_.acknowledge(played(), id);
  }
  std::int64_t begin_run() override { return played_.begin_run(played()); }
  icd::Checked<std::string> begin_ledger() override { return "ledger.damaged-1"; }
  Time identify(double seconds) override {
    identify_until_ = loop_.wall_now() + seconds;
    return identify_until_;
  }
  MarkerChanges markers(std::uint64_t) const override {
    return name_ == "empty" ? MarkerChanges{} : scene_markers(began_);
  }
  std::vector<Track> tracks(Time) const override {
    return name_ == "empty" ? std::vector<Track>{} : scene_tracks(began_);
  }
  const picture::Mosaic& map() const override { return name_ == "empty" ? blank_ : map_; }

  bool change_to(const std::string& name) {
    const bool known = scene(name, 0, 0).has_value();
    if (known) name_ = name;
    return known;
  }

 private:
  loop::Loop& loop_;
  Time began_, identify_until_ = 0;
  std::string name_;
  picture::Mosaic map_, blank_;
  Played played_;
};

/// A box that has run for a while.
void furnish(FakeBox& box, Time now) {
  box.self = {.version = "0.1.0",
              .build = "0123456789ab, GNU 12.2.0, Release",
              .licence = "Apache-2.0",
              .started = now - 4000,
              .kernel = "Linux 6.1.0 aarch64",
              .model = "A board",
              .parts = {{.name = "zlib", .version = "1.2.13", .licence = "Zlib"},
                        {.name = "libdeflate", .version = "1.14", .licence = "MIT"}}};
  box.say(5, "notice", "listening", "10.0.0.1:8000");
  box.say(6, "info", "refused", "msg.info.width: expected a whole number, got a string");
  box.say(4, "warning", "the Command Post refused a state", "<img src=x onerror=window.pwned=1>");
  box.say(3, "error", "the ledger cannot be written", "disk I/O error");
}

/// All steps of the set-up are done.
struct ReadySetup final : FakeSetup {
  bool is_saved() const override { return true; }
  std::vector<TokenRow> tokens() const override { return {{"scoring", true}, {"mapping", true}}; }
};

int serve(std::uint16_t port, const std::string& first, const std::string& more) {
  loop::Loop loop;
  Stage stage{loop, "empty"};
  if (!stage.change_to(first)) return std::fprintf(stderr, "no such scene: %s\n", first.c_str()), 2;
  FakeKeys keys;
  FakeBox box;
  if (more == "first-start") keys.operator_.reset();
  keys.set_up = more == "set-up-open";
  ReadySetup setup;
  FakeNetwork network;
  FakeTest test;
  PlayedUpdates updates;
  FakeKeptRuns runs;
  FakeClock clock;
  NoFinerMap finer;
  CountedMap covered{stage};
  PlayedSpare spare;
  PlayedCertificate certificate;
  const bool is_by_tls = more == "by-tls";
  if (is_by_tls || more == "https") certificate.offer();
  clock.view = {.now = loop.wall_now() - 7200, .managed = more == "clock-behind", .why = {}, .refusal = {}};
  Api page{loop,
           {.source = stage,
            .decisions = stage,
            .gateway_control = stage,
            .keys = keys,
            .setup = setup,
            .network = network,
            .test = test,
            .updates = updates,
            .box = box,
            .runs = runs,
            .clock = clock,
            .finer = finer,
            .covered = covered,
            .spare = spare,
            .certificate = certificate},
           {token()}};
  furnish(box, loop.wall_now());
  auto server = intake::Server::start(
      loop, {.address = "127.0.0.1", .port = port, .interface = {}, .by_tls = is_by_tls}, page);
  if (!server) return std::fprintf(stderr, "%s\n", server.error().c_str()), 1;
  std::printf("%d\n", (*server)->port());
  std::fflush(stdout);

  loop::Source second;
  second = loop.timer([&] {
    page.on_changed();
    second.call_at(loop.now() + std::chrono::seconds{1});
  });
  second.call_at(loop.now());
  std::string line;
  const auto input = loop.watch(STDIN_FILENO, EPOLLIN, [&](std::uint32_t) {
    char byte = 0;
    if (::read(STDIN_FILENO, &byte, 1) != 1) return loop.stop();
    if (byte != '\n') return line.push_back(byte);
    if (line.starts_with("say ")) return box.say(5, "notice", std::exchange(line, {}).substr(4));
    if (stage.change_to(std::exchange(line, {}))) page.on_changed();
  });
  loop.run();
  return 0;
}

}  // namespace
}  // namespace adit::api

int main(int count, char** arguments) {
  const int port =
      count > 1 ? std::atoi(arguments[1]) : 0;  // NOLINT(cert-err34-c): 0, any port, is right then
  return adit::api::serve(static_cast<std::uint16_t>(port), count > 2 ? arguments[2] : "calm",
                          count > 3 ? arguments[3] : "");
}
