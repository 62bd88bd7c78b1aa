#include "killed_ledger.hpp"

#include <iterator>

#include "folder.hpp"
#include "ledger/ledger.hpp"

namespace adit::fuzz {
namespace {

using dispatch::Report;
using dispatch::ReportState;

constexpr std::size_t kZerosKept = 8192;  // so that the log's end is seen

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

KilledLedger make_ledger() {
  const Folder folder;
  auto ledger = ledger::Ledger::open(folder.path());
  require(ledger.has_value());
  dispatch::Run run{.number = 1, .began = 5, .heard = 5, .post = "10.100.1.200:8000"};
  require(ledger->write(run).has_value());
  KilledLedger killed;
  for (std::int64_t number = 1; number <= 12; ++number) {
    Report report{.number = number,
                  .report = {"Backpack", {1.5 * static_cast<double>(number), -2, 0}},
                  .sender = "10.0.0.7"};
    report.received = report.changed = 10;
    report.run = 1;
    for (const auto state : {ReportState::Queued, ReportState::Sending, ReportState::Answered}) {
      if (number % 3 == 0 && state == ReportState::Answered) continue;
      report.state = state;
      report.status = state == ReportState::Answered ? 201 : 0;
      require(ledger->write(std::span(&report, 1)).has_value());
    }
    killed.reports.emplace(number, report);
  }
  run.heard = 15;  // for damage of what was written last may pass for a power cut
  require(ledger->write(run).has_value());
  killed.file = contents(folder / kLedgerFile);
  killed.log = contents(folder / kLedgerLog);
  killed.log_size = killed.log.size();
  killed.log.resize(killed.log.find_last_not_of('\0') + 1 + kZerosKept);
  return killed;
}

}  // namespace

void KilledLedger::damage(Input input) {
  const std::size_t in_file = file.size(), size = file.size() + log.size();
  for (; input.size() >= 5; input.remove_prefix(5)) {
    const auto bytes = bytes_of(input.substr(0, 5));
    const std::size_t at = (bytes[0] | bytes[1] << 8U | bytes[2] << 16U) % size;
    std::string& damaged = at < in_file ? file : log;
    const std::size_t place = at < in_file ? at : at - in_file;
    if (place >= damaged.size()) continue;
    damaged[place] = static_cast<char>(bytes[4]);
    if (bytes[3] == 0xff) damaged.resize(place);
  }
}

const KilledLedger& killed_ledger() {
  static const KilledLedger kKilled = make_ledger();
  return kKilled;
}

}  // namespace adit::fuzz
