#pragma once

#include <string>
#include <utility>
#include <vector>

#include "api/updates.hpp"

namespace adit::api {

/// Has the state that a test sets, and records requests.
struct FakeUpdates final : Updates {
  struct Received {
    std::uint64_t size = 0;
    bool again = false, whole = false, dropped = false;
    std::string bytes;
    std::function<void()> resume;
    std::function<void(icd::Checked<void>)> done;
  };

  UpdateView state() const override { return view; }
  icd::Checked<std::unique_ptr<Upload>> receive(std::uint64_t size, bool again,
                                                std::function<void()> resume) override {
    if (!outcome) return std::unexpected(outcome.error());
    received = {.size = size, .again = again, .bytes = {}, .resume = std::move(resume), .done = {}};
    return std::make_unique<Taking>(*this);
  }
  icd::Checked<void> install_from_stick(bool again) override {
    sticks.push_back(again);
    return outcome;
  }
  icd::Checked<void> restart(bool anyway) override {
    restarts.push_back(anyway);
    return outcome;
  }

  icd::Checked<void> restart_proven_slot(bool anyway) override {
    backs.push_back(anyway);
    return outcome;
  }
  icd::Checked<void> keep_running_slot() override {
    ++stays;
    return outcome;
  }

  UpdateView view;
  icd::Checked<void> outcome;
  Received received;
  bool more = true;  // the result for a piece
  std::vector<bool> sticks, restarts, backs;
  int stays = 0;

 private:
  struct Taking final : Upload {
    explicit Taking(FakeUpdates& updates) : owner(updates) {}
    ~Taking() override { owner.received.dropped = !owner.received.whole; }
    bool write(std::span<const std::uint8_t> piece) override {
      owner.received.bytes.append(piece.begin(), piece.end());
      return owner.more;
    }
    void finish(std::function<void(icd::Checked<void>)> done) override {
      owner.received.whole = true;
      owner.received.done = std::move(done);
    }
    FakeUpdates& owner;
  };
};

}  // namespace adit::api
