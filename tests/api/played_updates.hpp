#pragma once

#include <string>

#include "api/updates.hpp"

namespace adit::api {

/// A box that accepts any update whose last byte is not 'x', and has a queued report.
struct PlayedUpdates final : Updates {
  PlayedUpdates() {
    view.managed = view.runs_here = true;
    view.status.running = {"adit-a-board", "0.1.0", "A", "B"};
    view.status.last = {update::Stage::Left, "0.0.9", "B", "",
                        "the update did not become healthy in three starts"};
    view.status.stick = update::Offer{"adit-a-board-0.3.0.raucb", "0.3.0"};
  }
  UpdateView state() const override { return view; }
  icd::Checked<std::unique_ptr<Upload>> receive(std::uint64_t, bool, std::function<void()>) override {
    return std::make_unique<Taking>(view);
  }
  icd::Checked<void> install_from_stick(bool) override {
    view.status.doing = "installing";
    view.status.progress = 40;
    return {};
  }
  icd::Checked<void> restart(bool anyway) override {
    if (!anyway) return std::unexpected(icd::Refusal{icd::Status::Conflict, "1 report waits to be sent"});
    view.status.doing = "restarting";
    return {};
  }

  icd::Checked<void> restart_proven_slot(bool anyway) override { return restart(anyway); }
  icd::Checked<void> keep_running_slot() override {
    view.status.stray.clear();
    return {};
  }

  UpdateView view;

 private:
  struct Taking final : Upload {
    explicit Taking(UpdateView& told) : view(told) {}
    bool write(std::span<const std::uint8_t> piece) override {
      last = piece.back();
      return true;
    }
    void finish(std::function<void(icd::Checked<void>)> done) override {
      view.status.refusal = last == 'x' ? "Invalid bundle format: Signature size is 0" : "";
      if (last != 'x') view.status.last = {update::Stage::Installed, "0.2.0", "B", "", ""};
      done({});
    }
    UpdateView& view;
    std::uint8_t last = 0;
  };
};

}  // namespace adit::api
