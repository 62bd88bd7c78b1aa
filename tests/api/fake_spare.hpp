#pragma once

#include <string>
#include <utility>
#include <vector>

#include "api/spare.hpp"

namespace adit::api {

/// Is what it is told to be, and remembers what it was asked.
struct FakeSpare final : Spare {
  SpareView spare() const override { return view; }
  icd::Checked<void> stand_by() override { return said("standby"); }
  icd::Checked<void> resume() override { return said("resume"); }
  void export_to(Sealed done) override {
    const auto may = said("export");
    if (!may) return done(std::unexpected(may.error()));
    done(file);
  }
  void export_to_stick(Done done) override { done(said("export to the stick")); }
  icd::Checked<void> take_from_stick(const std::string& name) override { return said("take " + name); }
  icd::Checked<void> take_in(std::string taken) override {
    file = std::move(taken);
    return said("take");
  }
  void open(const std::string& code, Done done) override { done(said("open " + code)); }
  icd::Checked<void> forget() override { return said("forget"); }
  icd::Checked<void> take_over() override { return said("take over"); }

  icd::Checked<void> said(const std::string& what) {
    asked.push_back(what);
    return outcome;
  }

  SpareView view;
  icd::Checked<void> outcome;
  std::string file = "a sealed file";
  std::vector<std::string> asked;
};

}  // namespace adit::api
