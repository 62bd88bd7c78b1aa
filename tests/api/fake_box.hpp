#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "api/box.hpp"

namespace adit::api {

/// A box whose state a test sets.
struct FakeBox final : Box {
  std::vector<LogRecord> log(std::uint64_t after) const override {
    std::vector<LogRecord> rows;
    std::ranges::copy_if(records, std::back_inserter(rows),
                         [after](const LogRecord& record) { return record.seq > after; });
    return rows;
  }
  std::uint64_t last_record_number() const override { return records.empty() ? 0 : records.back().seq; }
  Usage usage() const override { return used; }
  About about() const override { return self; }
  NetworkState network() const override { return networks; }
  std::string settings() const override { return R"({"version":1})"; }
  void work(std::function<void()> work, std::function<void()> done) override {
    work();
    done();
  }

  /// Adds a log record about a report.
  void say(int severity, std::string level, std::string message, const std::string& note = "") {
    const std::uint64_t seq = last_record_number() + 1;
    LogRecord record{.seq = seq,
                     .at = 1'780'000'000 + static_cast<double>(seq),
                     .severity = severity,
                     .level = std::move(level),
                     .message = std::move(message),
                     .fields = {},
                     .line = ""};
    record.line = record.level + ": " + record.message;
    if (!note.empty()) {
      record.fields.emplace_back("note", note);
      record.line += " note=" + note;
    }
    records.push_back(std::move(record));
  }

  std::vector<LogRecord> records;
  Usage used;
  About self{.version = "0.1.0",
             .build = "a build",
             .licence = "Apache-2.0",
             .kernel = "",
             .model = "",
             .parts = {}};
  NetworkState networks;
};

}  // namespace adit::api
