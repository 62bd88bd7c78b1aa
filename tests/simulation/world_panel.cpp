// Implements panel/lines.hpp's simulated panel: records the lights in the history.
#include <optional>

#include "panel/lines.hpp"
#include "panel/reopened.hpp"
#include "simulation/world.hpp"

namespace adit::panel {
namespace {

using simulation::World;

class Shown final : public Lines {
 public:
  Shown() = default;
  Shown(const Shown&) = delete;
  Shown& operator=(const Shown&) = delete;
  ~Shown() override { show({}); }

  std::expected<void, std::string> set(const Lit& lit) override {
    show(lit);
    return {};
  }

 private:
  void show(const Lit& lit) {
    World& world = World::current();
    if (shown_ == lit || world.is_dead()) return;
    shown_ = lit;
    std::string bits;
    for (const bool each : lit) bits += each ? '1' : '0';
    world.note({.kind = simulation::Kind::Shows, .what = "the panel", .who = bits});
  }

  std::optional<Lit> shown_;
};

}  // namespace

std::unique_ptr<Lines> make_simulated_lines(std::string) {
  return std::make_unique<Shown>();
}

std::expected<PanelDevices, std::string> remote(const std::string&, const settings::Panel&,
                                                loop::FileDescriptor) {
  return PanelDevices{std::make_unique<Shown>(), nullptr};
}

loop::FileDescriptor announce(const std::string&) {
  return {};
}

}  // namespace adit::panel
