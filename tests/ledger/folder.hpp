#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "ledger/ledger.hpp"

namespace adit::ledger {

/// A folder of the test's own, gone with it.
class Folder {
 public:
  explicit Folder(const std::string& below = testing::TempDir()) {
    std::string pattern = below + "adit-ledger-XXXXXX";
    EXPECT_NE(::mkdtemp(pattern.data()), nullptr);
    path_ = pattern;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string text() const { return path_.string(); }
  std::string file() const { return (path_ / "ledger.sqlite").string(); }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void save(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline Ledger open_or_fail(const Folder& folder) {
  auto ledger = Ledger::open(folder.text());
  if (!ledger) throw std::runtime_error(ledger.error().what);
  return std::move(*ledger);
}

/// A new report, received at second 10.
inline dispatch::Report backpack(std::int64_t number, double x = 1.5) {
  dispatch::Report report;
  report.number = number;
  report.report = {"Backpack", {x, -2.25, 0.125}};
  report.sender = "10.0.0.7";
  report.received = report.changed = 10;
  return report;
}

/// One that names the robot that found it.
inline dispatch::Report named_backpack(std::int64_t number, std::string_view robot) {
  dispatch::Report report = backpack(number);
  report.report.robot = icd::RobotName::parse(robot);
  return report;
}

inline Result<void> write(Ledger& ledger, const dispatch::Report& report) {
  return ledger.write(std::span(&report, 1));
}

inline dispatch::Report find_or_fail(const Ledger& ledger, std::int64_t number) {
  const auto reports = ledger.reports();
  if (!reports) throw std::runtime_error(reports.error().what);
  for (const dispatch::Report& report : *reports) {
    if (report.number == number) return report;
  }
  throw std::runtime_error("no report " + std::to_string(number));
}

/// A connection of the test's own to a ledger that is closed. The first column of each row that `sql` gives.
inline std::vector<std::string> by_hand(const Folder& folder, const std::string& sql) {
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open(folder.file().c_str(), &database), SQLITE_OK);
  std::vector<std::string> rows;
  const auto collect = [](void* out, int, char** values, char**) {
    static_cast<std::vector<std::string>*>(out)->emplace_back(values[0] != nullptr ? values[0] : "NULL");
    return 0;
  };
  EXPECT_EQ(sqlite3_exec(database, sql.c_str(), collect, &rows, nullptr), SQLITE_OK)
      << sqlite3_errmsg(database);
  sqlite3_close(database);
  return rows;
}

}  // namespace adit::ledger
