#pragma once

#include <functional>
#include <string>

#include "api/box.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "settings/board.hpp"

namespace adit::box {

/// The page's facts about the box, from the kernel, the logger and the libraries.
class ThisBox final : public api::Box {
 public:
  /// `add_to` adds the gateway's counts. `loop` and `workers` outlive this.
  ThisBox(const loop::Loop& loop, loop::Workers& workers, settings::Board board, std::string settings,
          std::function<void(api::Usage&)> add_to);

  std::vector<api::LogRecord> log(std::uint64_t after) const override;
  std::uint64_t logged() const override;
  api::Usage usage() const override;
  api::About about() const override;
  api::NetworkState network() const override;
  std::string settings() const override { return settings_; }
  void runs_with(std::string settings) { settings_ = std::move(settings); }
  void work(std::function<void()> work, std::function<void()> done) override;

 private:
  /// Of the process, by the present time of day. The process may have had earlier gateways.
  api::Time started() const;

  const loop::Loop& loop_;
  loop::Workers& workers_;
  settings::Board board_;
  std::string settings_;
  std::function<void(api::Usage&)> add_to_;
};

}  // namespace adit::box
