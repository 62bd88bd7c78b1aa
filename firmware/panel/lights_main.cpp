/// adit-lights: the lights while aditd does not run. An output keeps its last value when the process that set
/// it dies, so without this a dead Adit would look well.

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>

#include "command_line/answer.hpp"
#include "panel/lights_options.hpp"
#include "panel/lines.hpp"
#include "panel/states.hpp"
#include "settings/board.hpp"

namespace {

using namespace adit;
using panel::Milliseconds;
using Clock = std::chrono::steady_clock;

/// Nothing: there is no such file, or it cannot be read.
std::optional<std::string> text_of(const std::string& path) {
  if (path.empty()) return std::nullopt;
  std::ifstream stream(path);
  if (!stream) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

void complain(const std::string& sentence) {
  std::fprintf(stderr, "adit-lights: %s\n", sentence.c_str());
}

/// The board's, or else that of the first settings that can be read; a file that is wrong is told and passed
/// over.
std::optional<settings::Panel> find_panel(const panel::LightsOptions& options) {
  if (const auto text = text_of(options.board)) {
    auto board = settings::parse_board(*text);
    if (!board) complain(options.board + ": " + settings::sentence_of(board.error()));
    if (board && board->panel) return std::move(board->panel);
  }
  for (const std::string& file : options.settings) {
    const auto text = text_of(file);
    if (!text) continue;
    auto settings = settings::parse_saved(*text);  // as aditd does: perhaps of a later Adit
    if (settings) return std::move(settings->settings.panel);
    complain(file + ": " + settings::sentence_of(settings.error()));
  }
  return std::nullopt;
}

std::expected<std::unique_ptr<panel::Lines>, std::string> open_lines(const panel::LightsOptions& options) {
  const auto settings = find_panel(options);
  if (!settings) return std::unexpected("neither a board nor settings tell where the lights are");
  if (settings->is_simulated() && !options.simulated.empty()) return panel::simulated(options.simulated);
  return panel::open_gpio(*settings, "adit-lights");
}

/// True: one came that ends this.
bool wait_for_the_end(const sigset_t& ending, Milliseconds most) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(most);
  const timespec length{.tv_sec = seconds.count(),
                        .tv_nsec = std::chrono::nanoseconds(most - seconds).count()};
  return sigtimedwait(&ending, nullptr, &length) > 0;
}

std::expected<void, std::string> show_fault(panel::Lines& lines, const panel::LightsOptions& options) {
  sigset_t ending;
  sigemptyset(&ending);
  for (const int number : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&ending, number);
  sigprocmask(SIG_BLOCK, &ending, nullptr);
  panel::States states;
  states.set(panel::State::Fault, true);
  const auto began = Clock::now();
  while (true) {
    const auto elapsed = std::chrono::duration_cast<Milliseconds>(Clock::now() - began);
    if (options.seconds && elapsed >= *options.seconds) return {};
    const panel::Frame frame = panel::frame_of(states.shown(), elapsed);
    if (auto set = lines.set(frame.lit); !set) return set;
    Milliseconds pause = frame.lasts.value_or(std::chrono::hours(1));
    if (options.seconds) pause = std::min<Milliseconds>(pause, *options.seconds - elapsed);
    if (wait_for_the_end(ending, pause)) return {};
  }
}

int run(const panel::LightsOptions& options) {
  using Word = panel::LightsOptions::Word;
  const auto lines = open_lines(options);
  const bool faulty = options.word == Word::Fault ||
                      (options.word == Word::Ended && panel::has_died(std::getenv("SERVICE_RESULT")));
  auto set = lines ? std::expected<void, std::string>() : std::unexpected(lines.error());
  if (lines && faulty) set = show_fault(**lines, options);
  if (lines && set) set = (*lines)->set({});
  if (set) return 0;
  complain(set.error());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  const auto options = panel::parse_lights_options({argv + 1, argv + argc});
  if (const auto exit = command_line::answer(panel::lights_command_line_of, ADIT_VERSION, options))
    return *exit;
  return run(*options);
}
