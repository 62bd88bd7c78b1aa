#include "panel/panel.hpp"

namespace adit::panel {
namespace {

Pattern health_of(const Condition& condition) {
  return condition.serving ? Pattern::On : Pattern::Fast;
}

Pattern scoring_of(const Condition& condition) {
  if (condition.scoring_failing) return Pattern::Fast;
  if (!condition.scoring_connected) return Pattern::Off;
  return condition.report_waiting ? Pattern::Slow : Pattern::On;
}

Pattern mapping_of(const Condition& condition) {
  if (condition.mapping_failing) return Pattern::Fast;
  return condition.mapping_connected ? Pattern::On : Pattern::Off;
}

Pattern attention_of(const Condition& condition) {
  return condition.needs_operator ? Pattern::Fast : Pattern::Off;
}

/// On for the first half of each period.
bool blinks_on(std::uint64_t elapsed_ms, std::uint64_t period_ms) {
  return elapsed_ms % period_ms < period_ms / 2;
}

}  // namespace

std::string_view name_of(Light light) {
  switch (light) {
    case Light::Health:
      return "health";
    case Light::Scoring:
      return "scoring";
    case Light::Mapping:
      return "mapping";
    case Light::Attention:
      return "attention";
  }
  return "unknown";
}

std::string_view name_of(Pattern pattern) {
  switch (pattern) {
    case Pattern::Off:
      return "off";
    case Pattern::On:
      return "on";
    case Pattern::Slow:
      return "slow";
    case Pattern::Fast:
      return "fast";
    case Pattern::Twice:
      return "twice";
  }
  return "unknown";
}

Lights lights_for(const Condition& condition) {
  return {health_of(condition), scoring_of(condition), mapping_of(condition), attention_of(condition)};
}

bool lit(Pattern pattern, std::uint64_t elapsed_ms) {
  switch (pattern) {
    case Pattern::Off:
      return false;
    case Pattern::On:
      return true;
    case Pattern::Slow:
      return blinks_on(elapsed_ms, 1000);
    case Pattern::Fast:
      return blinks_on(elapsed_ms, 250);
    case Pattern::Twice:
      return elapsed_ms % 1000 < 375 && blinks_on(elapsed_ms, 250);
  }
  return false;
}

}  // namespace adit::panel
