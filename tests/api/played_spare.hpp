#pragma once

#include <string>

#include "api/spare.hpp"

namespace adit::api {

/// A box with a stick that has another box's export and an unreadable one. Each look at the stick advances
/// it by one step.
struct PlayedSpare final : Spare {
  PlayedSpare() {
    view.stick = StickRow{
        .hindrance = "",
        .unreadable = "",
        .doing = "",
        .refusal = "",
        .written = "",
        .exports = {{.name = "adit-10.0.0.7-20250615T150640Z.adit-spare", .box = "10.0.0.7", .at = 1.75e9},
                    {.name = "zip.adit-spare", .box = "", .at = std::nullopt}}};
  }

  SpareView state() const override {
    SpareView shown = view;
    step();
    return shown;
  }
  icd::Checked<void> enter_standby() override {
    view.standby = true;
    view.why = "its spare takes over";
    view.code = "1234 5678 9012 3456";
    return {};
  }
  icd::Checked<void> resume() override {
    view.standby = false;
    view.code.clear();
    return {};
  }
  void export_to(Sealed done) override { done("a sealed file"); }
  void export_to_stick(Done done) override {
    ++written_;
    view.stick->doing = "writing";
    view.stick->refusal.clear();
    done({});
  }
  icd::Checked<void> import_from_stick(const std::string& name) override {
    view.stick->doing = "reading";
    view.stick->refusal.clear();
    taken_ = name;
    return {};
  }
  icd::Checked<void> import_file(std::string) override {
    view.asks_code = true;
    return {};
  }
  void open(const std::string&, Done done) override { done({}); }
  icd::Checked<void> forget() override {
    view.asks_code = false;
    return {};
  }
  icd::Checked<void> take_over() override { return {}; }

  mutable SpareView view;

 private:
  /// The first write fails.
  void step() const {
    StickRow& stick = *view.stick;
    if (stick.doing == "writing") {
      stick.doing = written_ == 1 ? "" : "checking";
      if (written_ == 1) stick.refusal = "the stick is full";
    } else if (stick.doing == "checking") {
      stick.doing.clear();
      stick.written = "adit-10.0.0.1-20250615T150640Z.adit-spare";
    } else if (stick.doing == "reading") {
      stick.doing.clear();
      view.asks_code = taken_ != "zip.adit-spare";
      if (!view.asks_code) stick.refusal = "the file is not an export from Adit";
    }
  }

  int written_ = 0;
  std::string taken_;
};

}  // namespace adit::api
