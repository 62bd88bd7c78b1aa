#include "simulation/reader.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "simulation/page_words.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr const char* kView = "/adit/run";
constexpr const char* kMetrics = "/metrics";
constexpr double kEvery = 5;
/// Lights and STATUS are updated each second, so they may be that old.
constexpr double kUpdateDelay = 1.1;
constexpr int kOften = 3;

/// Events that do not change the page.
bool is_silent(const Event& event) {
  return event.kind == Kind::Told || event.kind == Kind::Shows || event.kind == Kind::Opens ||
         event.kind == Kind::Closes || event.kind == Kind::Given || event.what == kView ||
         event.what == kMetrics;
}

bool anything_waits(const nlohmann::json& view) {
  const auto is_going = [](const nlohmann::json& report) {
    return report.at("state") == "queued" || report.at("state") == "sending";
  };
  return std::ranges::any_of(view.at("activities"), [](const auto& row) { return row.at("queued") > 0; }) ||
         std::ranges::any_of(view.at("reports"), is_going);
}

Stored stored(Disk& disk) {
  const std::uint64_t waiting = disk.stored("runtime/waiting/"), journal = disk.stored("runtime/journal/");
  return {.state = disk.stored("state/"),
          .waiting = waiting,
          .journal = journal,
          .others = disk.stored("runtime/") - waiting - journal};
}

}  // namespace

Reader::Reader(World& world, double until)
    : world_(world),
      client_(world, "10.0.0.11", {.keeps_alive = false, .patience = 20, .dribbles = 0},
              world.random("client of the reader")),
      until_(until) {
  world.after(seconds(world.random("reader").uniform(0, kEvery)), [this] { look(); });
}

void Reader::wait_for_rest(double from, double end, std::function<void()> rested) {
  end_ = end;
  rested_ = std::move(rested);
  world_.after(seconds(from), [this] { look_at_rest(); });
}

void Reader::look_at_rest() {
  const std::size_t before = readings_.size();
  look_at(kView, [this](const std::string& body) { viewed(body); });
  world_.after(seconds(kEvery), [this, before] {
    const bool nothing_waits = readings_.size() > before && !anything_waits(readings_.back().view);
    nothing_waits || world_.time() >= end_ ? rested_() : look_at_rest();
  });
}

void Reader::look() {
  if (world_.time() > until_) return;
  world_.after(seconds(kEvery), [this] { look(); });
  times_seen_ = 0;
  look_at(kView, [this](const std::string& body) { viewed(body); });
}

void Reader::look_at(const char* path, std::function<void(const std::string&)> got) {
  if (client_.busy()) return;
  const std::string headers = "Host: 10.0.0.1\r\nAuthorization: Bearer token-of-the-team\r\n";
  asked_ = world_.history().events().size();
  jobs_ended_ = world_.jobs_ended();
  client_.ask(http_request("GET", path, headers, ""), {.what = path, .who = "reader"},
              [this, got = std::move(got)](int status) {
                if (status == 200) got(client_.heard());
              });
}

void Reader::viewed(const std::string& body) {
  const auto& events = world_.history().events();
  Reading reading{.asked = asked_,
                  .heard = events.size(),
                  .at = events[asked_].at,
                  .process = events[asked_].process,
                  .view = nlohmann::json::parse(body),
                  .stored = stored(world_.disk())};
  world_.look_at_heap();
  const std::string difference = disagreement(reading.view, events, reading.asked);
  readings_.push_back(std::move(reading));
  look_at(kMetrics, [this, jobs = jobs_ended_](const std::string& text) {
    readings_.back().metrics = text;
    readings_.back().measured = world_.history().events().size();
    readings_.back().worked = world_.jobs_ended() != jobs;
  });
  confirm(difference);
}

/// The state may have changed just now. It is a violation only if the difference stays and no event happens
/// meanwhile.
void Reader::confirm(const std::string& difference) {
  const auto& events = world_.history().events();
  const std::size_t since = readings_.size() > 1 ? readings_[readings_.size() - 2].asked : 0;
  const bool is_quiet =
      std::all_of(events.begin() + static_cast<std::ptrdiff_t>(since), events.end(), is_silent);
  times_seen_ = difference.empty() ? 0 : difference == difference_ && is_quiet ? times_seen_ + 1 : 1;
  if (times_seen_ == 1) since_ = world_.time();
  difference_ = difference;
  if (times_seen_ >= kOften && world_.time() - since_ > kUpdateDelay) {
    readings_.back().difference = difference;
  } else if (times_seen_ > 0) {
    world_.after(seconds(kUpdateDelay),
                 [this] { look_at(kView, [this](const std::string& body) { viewed(body); }); });
  }
}

}  // namespace adit::simulation
