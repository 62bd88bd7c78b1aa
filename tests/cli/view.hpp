#pragma once

#include <string>

#include "api/run_view.hpp"

namespace adit::cli {

/// An example run at 1000 s of the gateway's clock, without anything for the operator to decide.
inline api::RunView sample_view() {
  api::RunView view;
  view.now = 1000;
  view.version = "0.1.0";
  view.run = {.score = 7, .run_clock = 754.5, .remaining_reports = 18, .current_team = "cave_club"};
  view.run_clock = {.seconds = 754.9, .age = 0.4, .runs = true};
  view.budget_mbit = 100;
  view.sent_mbit = 12.34;
  view.queued_bytes = 3400000;
  view.endpoints = {{.name = "scoring",
                     .address = "10.100.1.200:8000",
                     .last_status = 201,
                     .answer_ms = 3.42,
                     .word = "connected"},
                    {.name = "mapping",
                     .address = "10.100.1.201:8000",
                     .last_status = 200,
                     .answer_ms = 42.1,
                     .word = "connected"}};
  facts::ReportRow report;
  report.number = 3;
  report.type = "Survivor";
  report.position = {12.125, -3, 0.5};
  report.sender = "10.0.0.7";
  report.received = 940;
  report.changed = 941;
  report.state = "answered";
  report.status = 201;
  report.report_status = "scored";
  report.score_change = 1;
  view.reports = {report};
  facts::ActivityRow grid;
  grid.kind = "grid";
  grid.robot = "r1";
  grid.accepted = 12;
  grid.forwarded = 11;
  grid.last_accepted = 999;
  grid.last_forwarded = 999.5;
  grid.age = 0.5, grid.heard = 0.4;
  grid.bytes_received = 64000;
  grid.bytes_sent = 4000;
  grid.last_status = 200;
  grid.arrival = facts::Arrival::UpToDate;
  grid.level = facts::Level::Good;
  grid.word = "up to date";
  view.activities = {grid};
  return view;
}

/// Adit's answer to GET /adit/settings with these settings.
inline std::string setup_json(const std::string& settings, const std::string& trouble = "") {
  return R"({"settings":)" + settings +
         R"(,"tag":"0123456789abcdef","saved":true,"applying":false,"trouble":")" + trouble +
         R"(","tokens":{"scoring":true,"team":false},"odd_tokens":[],"keys":[]})";
}

}  // namespace adit::cli
