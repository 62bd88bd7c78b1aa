#pragma once

#include <gmock/gmock.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "ledger/ledger.hpp"
#include "store/log.hpp"

namespace adit::ledger {

using Files = std::map<std::string, std::string>;  // by name

inline Files files_in(const std::string& directory) {
  Files files;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    if (!entry.is_regular_file()) continue;
    std::string& bytes = files[entry.path().filename()];
    bytes.resize(entry.file_size());
    std::ifstream(entry.path(), std::ios::binary)
        .read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  return files;
}
/// Makes the directory contain exactly these files.
inline void put_files(const std::string& directory, const Files& files) {
  std::filesystem::remove_all(directory);
  std::filesystem::create_directories(directory);
  for (const auto& [name, bytes] : files) std::ofstream(directory + '/' + name, std::ios::binary) << bytes;
}

/// A state directory for one test.
class State {
 public:
  State() {
    path_ =
        std::filesystem::exists("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path().native();
    path_ += "/adit-ledger-XXXXXX";
    if (::mkdtemp(path_.data()) == nullptr) throw std::runtime_error("no directory");
  }
  ~State() { std::filesystem::remove_all(path_); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  const std::string& path() const { return path_; }
  std::string ledger() const { return path_ + '/' + Ledger::kDirectory; }

 private:
  std::string path_;
};

inline Ledger open_or_fail(const std::string& state, const LedgerFacts& known = {},
                           const std::string& memory = "") {
  auto ledger = Ledger::open(state, known, memory);
  if (!ledger) throw std::runtime_error(ledger.error().what);
  return std::move(*ledger);
}

/// A new report, received at second 10.
inline dispatch::Report backpack(std::int64_t number, double x = 1.5) {
  return {.number = number,
          .report = {"Backpack", {x, -2.25, 0.125}},
          .sender = "10.0.0.7",
          .received = 10,
          .changed = 10,
          .run = 1};
}
inline dispatch::Report in_state(dispatch::Report report, dispatch::ReportState state) {
  report.state = state;
  return report;
}

inline Result<void> write(Ledger& ledger, const dispatch::Report& report,
                          dispatch::Flush flush = dispatch::Flush::Now) {
  return ledger.write(std::span(&report, 1), nullptr, flush);
}

/// Writes new reports from number `first` on, until the current file has no room for another one. Returns
/// the next number.
inline std::int64_t fill_file(Ledger& ledger, std::int64_t first) {
  const std::uint64_t log = ledger.known_facts().log;
  std::int64_t number = first;
  while (write(ledger, backpack(number)) && ledger.known_facts().log == log) ++number;
  return number;
}

/// Writes the log of a ledger that no process has open.
template <class Use>
void use_log(const std::string& directory, Use use) {
  const auto locked = store::Directory::lock(directory).value();
  store::Log log(locked, Ledger::kKeeping);
  log.start(store::Contents::read(locked, Ledger::kKeeping).value()).value();
  use(log).value();
}
inline void turn_log(const std::string& directory) {
  use_log(directory, [](store::Log& log) { return log.turn(); });
}
inline void append(const std::string& directory, std::uint8_t kind, std::string_view body) {
  use_log(directory, [&](store::Log& log) { return log.append(kind, body, store::Durability::Now); });
}

/// The work that follows a minute after the start.
inline Result<void> keep_up(Ledger& ledger) {
  const auto work = ledger.upkeep();
  const Result<void> done = work ? work() : Result<void>();
  if (work) ledger.on_upkeep_done(done);
  return done;
}

inline dispatch::Report find_or_fail(const Ledger& ledger, std::int64_t number) {
  for (const dispatch::Report& report : ledger.reports()) {
    if (report.number == number) return report;
  }
  throw std::runtime_error("no report " + std::to_string(number));
}

}  // namespace adit::ledger
