#include "simulation/history.hpp"

#include <cmath>
#include <cstdio>
#include <iterator>
#include <ranges>
#include <string_view>

namespace adit::simulation {
namespace {

constexpr const char* kWords[] = {"requests",
                                  "has requested",
                                  "stalls at",
                                  "is answered",
                                  "gets no answer",
                                  "sends",
                                  "ends",
                                  "has sent",
                                  "must not send",
                                  "reads",
                                  "opens",
                                  "closes",
                                  "accepts",
                                  "begins",
                                  "gets SIGTERM",
                                  "dies",
                                  "power cut",
                                  "cannot begin",
                                  "ended",
                                  "saved",
                                  "records another's",
                                  "new run",
                                  "fault",
                                  "written",
                                  "serves",
                                  "mended",
                                  "copies",
                                  "puts back",
                                  "slow",
                                  "calm",
                                  "notifies",
                                  "clock is set",
                                  "shows",
                                  "gives a second",
                                  ""};
static_assert(std::size(kWords) == static_cast<std::size_t>(Kind::Said) + 1);

void mix(std::uint64_t& hash, std::uint64_t number) {
  for (int i = 0; i < 8; ++i, number >>= 8) hash = (hash ^ (number & 0xFF)) * 0x100000001B3u;
}
void mix(std::uint64_t& hash, std::string_view text) {
  for (const char letter : text) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001B3u;
}

bool is_of_the_story(const Event& event) {
  if (event.kind == Kind::Told || event.kind == Kind::Shows) return false;
  if (event.kind == Kind::Opens || event.kind == Kind::Closes || event.kind == Kind::Given) return false;
  if (event.actor == Actor::Team && event.who == "reader") return false;
  if (event.kind == Kind::Said) return !event.text.starts_with("info");
  return event.what != "/api/status" || event.kind == Kind::Fault || event.actor == Actor::Team;
}

}  // namespace

void History::note(Event event) {
  if (event.kind != Kind::Said) {
    mix(hash_, static_cast<std::uint64_t>(std::llround(event.at * 1e6)));
    mix(hash_, static_cast<std::uint64_t>(event.kind) << 8 | static_cast<std::uint64_t>(event.actor));
    mix(hash_, event.what);
    mix(hash_, event.who);
    mix(hash_, static_cast<std::uint64_t>(event.serial));
    mix(hash_, static_cast<std::uint64_t>(event.status));
    mix(hash_, static_cast<std::uint64_t>(std::llround(event.stamp * 1e6)));
    for (const int number : event.says) mix(hash_, static_cast<std::uint64_t>(number));
  }
  if (event.kind == Kind::Fault) ++faults_;
  if (tells == Telling::All || (tells == Telling::Story && is_of_the_story(event)))
    std::puts(line_of(event).c_str());
  events_.push_back(std::move(event));
}

std::string line_of(const Event& event) {
  char time[32];
  std::snprintf(time, sizeof time, "%10.6f ", event.at);
  std::string words = kWords[static_cast<int>(event.kind)];
  const auto add = [&words](const std::string& word) {
    words.append(words.empty() || word.empty() ? 0 : 1, ' ').append(word);
  };
  if (event.status != 0) add(std::to_string(event.status));
  add(event.what);
  add(event.who);
  if (event.serial != 0) add(std::to_string(event.serial));
  if (event.stamp != 0) {
    char stamp[32];
    std::snprintf(stamp, sizeof stamp, "(%.6f)", event.stamp);
    add(stamp);
  }
  for (const int number : event.says | std::views::take(5)) add(std::to_string(number));
  add(event.text);
  constexpr std::size_t kColumn = 44;
  const std::size_t column = static_cast<std::size_t>(event.actor) * kColumn;
  return time + std::string(column, ' ') + words;
}

}  // namespace adit::simulation
