/// adit-panel: holds the lights and the button. A GPIO output keeps its value when its process hangs or dies,
/// so aditd cannot show its own fault.
#include <systemd/sd-daemon.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>

#include "command_line/read.hpp"
#include "loop/regular_file.hpp"
#include "loop/watchdog.hpp"
#include "panel/keeper.hpp"
#include "panel/messages.hpp"
#include "settings/board.hpp"

namespace adit::panel {

struct PanelOptions {
  std::string board, socket, simulated;
  bool help = false, version = false;
};

[[gnu::cold]] command_line::Program panel_command_line_of(PanelOptions& options);

command_line::Program panel_command_line_of(PanelOptions& options) {
  return {
      .name = "adit-panel",
      .about = "Hold the panel's lights and button for aditd. If aditd dies or hangs, show the fault.",
      .rows = {{"--board", "FILE",
                "the board's description (board.json); if it names a panel, that panel is used instead of "
                "aditd's",
                &options.board},
               {"--socket", "SOCKET", "socket for aditd (aditd --panel); not with a socket from systemd",
                &options.socket},
               {"--simulated", "FILE",
                "show the lights in this file while no line is named; the button is the FIFO FILE.button",
                &options.simulated}},
      .ending =
          "Exit code: 0 after SIGTERM or SIGINT, with all lights dark; 1 if it cannot start; 2 for a wrong "
          "command line.",
      .empty = command_line::EmptyValue::Accepted,
  };
}

}  // namespace adit::panel

namespace {

using namespace adit;

constexpr const char* kConsumer = "adit-panel";
constexpr std::size_t kLargestBoard = 1 << 20;

void complain(const std::string& sentence) {
  std::fprintf(stderr, "adit-panel: %s\n", sentence.c_str());
}

/// nullopt: no file, or it names no panel or is wrong, which is logged. Error: the file cannot be read.
std::expected<std::optional<settings::Panel>, std::string> panel_of_board(const std::string& file) {
  const loop::FileDescriptor fd = loop::open_regular(file, O_RDONLY);
  if (!fd && errno == ENOENT) return std::nullopt;  // also if `file` is ""
  const auto text = fd ? loop::read_all(fd, kLargestBoard) : std::unexpected(errno);
  if (!text) return std::unexpected(file + ": " + loop::text_of(text.error()));
  auto board = settings::parse_board(*text);
  if (board) return std::move(board->panel);
  complain(file + ": " + settings::sentence_of(board.error()));
  return std::nullopt;
}

/// The socket from systemd, or a new one.
std::expected<loop::FileDescriptor, std::string> listening(const std::string& socket) {
  const int given = sd_listen_fds(1);
  if (given > 1) return std::unexpected("systemd gave more than one socket");
  if (given == 1) {
    loop::FileDescriptor fd(SD_LISTEN_FDS_START);
    if (sd_is_socket_unix(fd.get(), SOCK_SEQPACKET, 1, nullptr, 0) > 0) return fd;
    return std::unexpected("systemd's socket is not a listening SOCK_SEQPACKET socket");
  }
  if (socket.empty()) return std::unexpected("--socket is missing, and systemd gave no socket");
  auto made = panel::listening_at(socket);
  if (!made) return std::unexpected(socket + ": " + std::system_category().message(errno));
  return made;
}

int run(const panel::PanelOptions& options) {
  auto socket = listening(options.socket);
  const auto board = panel_of_board(options.board);
  if (!socket || !board) {
    complain(socket ? board.error() : socket.error());
    return 1;
  }
  loop::Loop loop;
  panel::Keeper keeper(loop, std::move(*socket), *board,
                       {.open =
                            [&](const settings::Panel& panel) {
                              return panel::hold(panel, kConsumer, options.simulated, &complain);
                            },
                        .complain = &complain});
  const auto terminated = loop.signal(SIGTERM, [&] { loop.stop(); });
  const auto interrupted = loop.signal(SIGINT, [&] { loop.stop(); });
  std::optional<loop::Watchdog> watchdog;
  std::uint64_t usec = 0;
  if (sd_watchdog_enabled(0, &usec) > 0) {
    watchdog.emplace(loop, std::chrono::microseconds(usec), [] { sd_notify(0, "WATCHDOG=1"); });
  }
  sd_notify(0, "READY=1");
  loop.run();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return command_line::run<panel::PanelOptions>(panel::panel_command_line_of, ADIT_VERSION, argc, argv, run);
}
