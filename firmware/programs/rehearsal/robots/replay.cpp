#include "rehearsal/robots/replay.hpp"

#include <chrono>
#include <utility>

#include "rehearsal/robots/explorer.hpp"
#include "rehearsal/robots/maps/map_file.hpp"

namespace adit::robots {

std::expected<std::string, std::string> replay_file(const std::filesystem::path& file, Client& client,
                                                    const std::stop_token& finish) {
  constexpr std::chrono::milliseconds kBetween{1100};
  auto map = load_map(file);
  if (!map) return std::unexpected(map.error());
  const std::chrono::duration<double> now = std::chrono::system_clock::now().time_since_epoch();
  const Message message = std::visit(
      [&](auto& loaded) -> Message {
        loaded.stamp = now.count();
        return std::move(loaded);
      },
      *map);
  while (!finish.stop_requested()) {
    const auto reply = client.send(message);
    pause_until(std::chrono::steady_clock::now() + kBetween, finish);
    if (reply && reply->status != 429) {
      return "replay posts " + file.string() + ": " + std::to_string(reply->status);
    }
  }
  return "replay did not post " + file.string();
}

}  // namespace adit::robots
