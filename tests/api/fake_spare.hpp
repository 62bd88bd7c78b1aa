#pragma once

#include <string>
#include <utility>
#include <vector>

#include "api/spare.hpp"

namespace adit::api {

/// Has the state that a test sets, and records requests.
struct FakeSpare final : Spare {
  SpareView state() const override { return view; }
  icd::Checked<void> enter_standby() override { return record("standby"); }
  icd::Checked<void> resume() override { return record("resume"); }
  void export_to(Sealed done) override {
    const auto permitted = record("export");
    if (!permitted) return done(std::unexpected(permitted.error()));
    done(file);
  }
  void export_to_stick(Done done) override { done(record("export to the stick")); }
  icd::Checked<void> import_from_stick(const std::string& name) override { return record("take " + name); }
  icd::Checked<void> import_file(std::string taken) override {
    file = std::move(taken);
    return record("take");
  }
  void open(const std::string& code, Done done) override { done(record("open " + code)); }
  icd::Checked<void> forget() override { return record("forget"); }
  icd::Checked<void> take_over() override { return record("take over"); }

  icd::Checked<void> record(const std::string& what) {
    asked.push_back(what);
    return outcome;
  }

  SpareView view;
  icd::Checked<void> outcome;
  std::string file = "a sealed file";
  std::vector<std::string> asked;
};

}  // namespace adit::api
