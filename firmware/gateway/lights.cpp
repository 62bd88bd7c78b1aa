#include "gateway/lights.hpp"

#include <algorithm>

#include "host/log.hpp"

namespace adit::gateway {
namespace {

constexpr std::chrono::milliseconds kTick{125};  // half a period of the fastest pattern

bool blinks(panel::Pattern pattern) {
  return pattern != panel::Pattern::Off && pattern != panel::Pattern::On;
}

}  // namespace

Lights::Lights(loop::Loop& loop, std::unique_ptr<panel::Lines> lines)
    : loop_(loop), lines_(std::move(lines)), began_(loop.now()), tick_(loop.timer([this] { paint(); })) {}

void Lights::show(const panel::Condition& condition) {
  condition_ = panel::lights_for(condition);
  paint();
}

void Lights::identify(loop::Duration length) {
  identify_until_ = loop_.now() + length;
  paint();
}

std::optional<loop::Duration> Lights::identifying() const {
  const loop::Instant now = loop_.now();
  return now < identify_until_ ? std::optional(identify_until_ - now) : std::nullopt;
}

void Lights::paint() {
  shown_ = identifying() ? panel::kIdentify : condition_;
  const auto elapsed = std::chrono::duration_cast<std::chrono::milliseconds>(loop_.now() - began_);
  std::array<bool, panel::kLights.size()> lit{};
  std::ranges::transform(shown_, lit.begin(), [&](panel::Pattern pattern) {
    return panel::lit(pattern, static_cast<std::uint64_t>(elapsed.count()));
  });
  if (!painted_ || lit != lit_) {
    const auto set = lines_->set(lit);
    if (!set && !std::exchange(broken_, true)) {
      host::log(host::Level::Error, "the panel's lights cannot be set", {{"why", set.error()}});
    }
    if (set) broken_ = false;
    lit_ = lit;
    painted_ = true;
  }
  if (std::ranges::any_of(shown_, blinks)) {
    tick_.call_at(began_ + (elapsed / kTick + 1) * kTick);
  } else {
    tick_.cancel();
  }
}

}  // namespace adit::gateway
