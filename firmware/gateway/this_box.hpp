#pragma once

#include <functional>
#include <string>

#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "page/box.hpp"
#include "settings/board.hpp"

namespace adit::gateway {

/// What the page tells of the box: asked of the kernel, the logger and the libraries.
class ThisBox final : public page::Box {
 public:
  /// `add_to` adds what the gateway itself counts. `workers` outlives this.
  ThisBox(const loop::Loop& loop, loop::Workers& workers, settings::Board board, std::string settings,
          std::function<void(page::Usage&)> add_to);

  std::vector<page::LogRecord> log(std::uint64_t after) const override;
  std::uint64_t logged() const override;
  page::Usage usage() const override;
  page::About about() const override;
  page::NetworkState network() const override;
  std::string settings() const override { return settings_; }
  void runs_with(std::string settings) { settings_ = std::move(settings); }
  void work(std::function<void()> work, std::function<void()> done) override;

 private:
  loop::Workers& workers_;
  settings::Board board_;
  std::string settings_;
  std::function<void(page::Usage&)> add_to_;
  page::Time started_;  // the process, of which the gateway may not be the first
};

}  // namespace adit::gateway
