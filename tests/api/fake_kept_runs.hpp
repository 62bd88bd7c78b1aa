#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "api/kept_runs.hpp"

namespace adit::api {

/// Kept runs in memory. Answers synchronously.
struct FakeKeptRuns final : KeptRuns {
  RunList list() const override { return all; }
  History history(Time since) const override {
    asked_since = since;
    return plots;
  }
  void read(const std::string& key, ReadDone done) override {
    if (const auto why = refusal(key)) return done(std::unexpected(*why));
    done(kept);
  }
  void report(const std::string& key, std::vector<ReportDetail> reports, std::vector<ColourRow> /*colours*/,
              ReportDone done) override {
    reported = std::move(reports);
    if (const auto why = refusal(key)) return done(std::unexpected(*why));
    done("<!doctype html>");
  }
  void remove(const std::string& key, std::function<void(std::expected<void, std::string>)> done) override {
    const auto run = std::ranges::find(all.runs, key, &RunRow::key);
    if (run == all.runs.end()) return done(std::unexpected("there is no such run"));
    all.runs.erase(run);
    done({});
  }

  std::optional<icd::Refusal> refusal(const std::string& key) const {
    if (!unreadable.empty()) return icd::Refusal{icd::Status::ServiceUnavailable, unreadable};
    if (kept == nullptr || kept->facts.key != key) return no_such_run();
    return std::nullopt;
  }

  RunList all;
  History plots;
  std::shared_ptr<KeptRun> kept;
  std::vector<ReportDetail> reported;
  std::string unreadable;  // why no run can be read; empty: all can
  mutable Time asked_since = 0;
};

}  // namespace adit::api
