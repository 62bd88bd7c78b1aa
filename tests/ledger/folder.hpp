#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "ledger/ledger.hpp"

namespace adit::ledger {

/// A folder of the test's own, gone with it.
class Folder {
 public:
  Folder() {
    std::string pattern = testing::TempDir() + "adit-ledger-XXXXXX";
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

inline Ledger open_or_fail(const Folder& folder) {
  auto ledger = Ledger::open(folder.text());
  if (!ledger) throw std::runtime_error(ledger.error().what);
  return std::move(*ledger);
}

inline Entry find_or_fail(const Ledger& ledger, std::int64_t number) {
  const std::optional<Entry> found = ledger.find(number).value_or(std::nullopt);
  if (!found) throw std::runtime_error("no report " + std::to_string(number));
  return *found;
}

inline icd::ArtifactReport backpack(double x = 1.5) {
  return {"Backpack", {x, -2.25, 0.125}};
}

}  // namespace adit::ledger
