#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "api/reports_csv.hpp"
#include "api/run_view.hpp"
#include "cli/follower.hpp"
#include "cli/handlers.hpp"
#include "cli/screen.hpp"
#include "cli/status_text.hpp"
#include "cli/watch_text.hpp"
#include "cli/where.hpp"
#include "cli/words.hpp"
#include "codec/json.hpp"
#include "host/log.hpp"

namespace adit::cli {
namespace {

using Clock = Follower::Clock;

/// A form of display.
class Shown {
 public:
  virtual ~Shown() = default;
  virtual void show(const Look& seen) = 0;
  /// Least time between two displays.
  virtual std::chrono::milliseconds spacing() const { return std::chrono::seconds(1); }
};

class AsJson : public Shown {
 public:
  explicit AsJson(const Console& console) : console_(console) {}
  void show(const Look& seen) override {
    if (seen) console_.print(codec::write_json(seen->told) + '\n');
  }

 private:
  const Console& console_;
};

class AsLines : public Shown {
 public:
  explicit AsLines(const Console& console) : console_(console) {}
  void show(const Look& seen) override {
    const std::string trouble = seen ? "" : seen.error();
    if (trouble != trouble_)
      console_.print(trouble.empty() ? "Adit answers again\n" : host::escaped(trouble) + '\n');
    trouble_ = trouble;
    if (!seen) return;
    console_.print(before_ ? changes_text(*before_, seen->view, console_.colour)
                           : status_text(seen->view, console_.colour) + '\n');
    before_ = seen->view;
  }
  std::chrono::milliseconds spacing() const override { return {}; }  // shows every change

 private:
  const Console& console_;
  std::optional<api::RunView> before_;
  std::string trouble_;
};

class OnScreen : public Shown {
 public:
  OnScreen(const Console& console, std::string where)
      : console_(console), where_(std::move(where)), screen_(console.print) {}
  void show(const Look& seen) override {
    if (seen) last_ = seen->view;
    const std::string at = last_ ? "  " + api::iso_time(last_->now) : "";
    const std::string head = "adit watch  " + where_ + at + "  q ends\n";
    const std::string trouble = seen
                                    ? ""
                                    : painted("NO ANSWER, the display is old: " + host::escaped(seen.error()),
                                              Tone::Bad, console_.colour) +
                                          '\n';
    screen_.show(painted(head, Tone::Faint, console_.colour) + trouble +
                 (last_ ? status_text(*last_, console_.colour) : ""));
  }

 private:
  const Console& console_;
  std::string where_;
  Screen screen_;
  std::optional<api::RunView> last_;
};

std::unique_ptr<Shown> shown_for(const Options& options, const Console& console, const Adit& adit) {
  if (options.json) return std::make_unique<AsJson>(console);
  if (console.screen) return std::make_unique<OnScreen>(console, written(adit.address));
  return std::make_unique<AsLines>(console);
}

}  // namespace

Result<Outcome> watch(const Call& call) {
  const auto& [adit, options, console] = call;
  const bool drawn = console.screen && !options.json;
  Patience patience(drawn && isatty(STDIN_FILENO) == 1);
  Follower follower(adit);
  std::unique_ptr<Shown> shown;  // created with the first display
  std::optional<Look> seen;
  bool is_news = false;
  Clock::time_point next{};
  while (true) {
    if (auto look = follower.look()) {
      if (!seen && !*look) return failed(look->error());
      seen = std::move(look);
      is_news = true;
    }
    if (!shown && seen) shown = shown_for(options, console, adit);
    if (is_news && Clock::now() >= next) {
      shown->show(*seen);
      next = Clock::now() + shown->spacing();
      is_news = false;
    }
    const auto until = is_news ? std::min(next, follower.due()) : follower.due();
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
    const auto woken = patience.wait(std::max(left, std::chrono::milliseconds(0)), follower.fd());
    if (woken == Patience::Woken::ToEnd) return Outcome{};
    if (woken == Patience::Woken::ByChange && drawn && shown) shown->show(*seen);
  }
}

}  // namespace adit::cli
