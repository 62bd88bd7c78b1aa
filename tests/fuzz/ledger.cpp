// The ledger: records that anybody wrote, and a directory whose log is damaged.
#include "ledger/ledger.hpp"

#include "folder.hpp"
#include "ledger/book.hpp"

namespace adit::fuzz {
namespace {

using dispatch::Report;
using dispatch::ReportState;
using ledger::Book;

/// The input is a list of records: a byte for the kind, two for the length, and the body. A record that is
/// understood is the same after it is written and read again.
void try_records(Input input) {
  Book book;
  while (input.size() >= 3) {
    const auto bytes = bytes_of(input.substr(0, 3));
    const std::size_t size = bytes[1] | bytes[2] << 8U;
    (void)book.apply(bytes[0], input.substr(3, size));
    input.remove_prefix(std::min(input.size(), 3 + size));
  }
  Book again;
  for (const auto& [kind, body] : book.records()) require(again.apply(kind, body));
  require(again.records() == book.records() && ledger::Ledger::is_copy(book.copy()));
  (void)book.runs();
  for (const Report& report : book.reports()) (void)book.history(report.number);
  require(ledger::more_of_report(ledger::to_bytes(Report{.number = 1}, input)) == input);
  require(ledger::more_of_run(ledger::to_bytes(dispatch::Run(), input)) == input);
}

struct Killed {
  std::string name, log;
  std::map<std::int64_t, Report> reports;
  std::size_t end = 0;  // of all records but the last one, whose frame says that those before it were synced
};

Killed make_ledger() {
  const Folder folder;
  auto ledger = ledger::Ledger::open(folder.path());
  require(ledger.has_value());
  const dispatch::Run run{.number = 1, .began = 5, .heard = 5, .post = "10.100.1.200:8000"};
  Killed killed;
  for (std::int64_t number = 1; number <= 12; ++number) {
    Report report{.number = number, .report = {"Backpack", {1.5, -2, 0}}, .sender = "10.0.0.7", .run = 1};
    for (const auto state : {ReportState::Queued, ReportState::Sending, ReportState::Answered}) {
      if (number % 3 == 0 && state == ReportState::Answered) continue;
      report.state = state;
      require(ledger->write(std::span(&report, 1)).has_value());
    }
    killed.reports.emplace(number, report);
  }
  require(ledger->write(run).has_value());
  const std::filesystem::path file = *std::filesystem::directory_iterator(folder / "ledger");
  killed.name = "ledger/" + file.filename().string();
  killed.log.resize(std::filesystem::file_size(file));
  std::ifstream(file, std::ios::binary)
      .read(killed.log.data(), static_cast<std::streamsize>(killed.log.size()));
  killed.end = (killed.log.find_last_not_of('\0') / 8192) * 8192;
  return killed;
}

/// Of each five bytes three say where, and one what stands there now; 0xff in the fourth cuts the file there.
std::string damaged(std::string log, std::size_t end, Input input) {
  for (; input.size() >= 5; input.remove_prefix(5)) {
    const auto bytes = bytes_of(input.substr(0, 5));
    const std::size_t at = (bytes[0] | bytes[1] << 8U | bytes[2] << 16U) % end;
    if (at >= log.size()) continue;
    log[at] = static_cast<char>(bytes[4]);
    if (bytes[3] == 0xff) log.resize(at);
  }
  return log;
}

/// Nothing is there that was not, nothing that was sent is sent again unasked, and all that is missing is
/// said.
void try_damage(Input input) {
  static const Folder folder;
  static const Killed kKilled = make_ledger();
  folder.clear();
  folder.put(kKilled.name, damaged(kKilled.log, kKilled.end, input));
  const auto ledger = ledger::Ledger::open(folder.path());
  if (!ledger) return require(!ledger.error().what.empty());
  std::size_t same = 0;
  for (const Report& report : ledger->reports()) {
    const auto was = kKilled.reports.find(report.number);
    if (report.is_lost()) continue;
    require(was != kKilled.reports.end() && was->second.report == report.report);
    same += report == was->second ? 1 : 0;
    require(report == was->second || report.state == ReportState::InDoubt);
  }
  require(same == kKilled.reports.size() || !ledger->damage().empty());
}

}  // namespace

void try_ledger(Input input) {
  if (input.empty()) return;
  const bool damages = input.front() % 2 == 1;
  input.remove_prefix(1);
  damages ? try_damage(input) : try_records(input);
}

}  // namespace adit::fuzz
