#include "simulation/ledger_reading.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>

#include "store/second_reader.hpp"

namespace adit::simulation {
namespace {

namespace fs = std::filesystem;

class Cursor {
 public:
  explicit Cursor(std::string bytes) : bytes_(std::move(bytes)) {}

  std::int64_t number() {
    std::int64_t number = 0;
    std::memcpy(&number, take(8), 8);
    return number;
  }
  double real() {
    double real = 0;
    std::memcpy(&real, take(8), 8);
    return real;
  }
  std::string text() {
    const auto size = static_cast<std::size_t>(number());
    return {take(size), size};
  }
  std::optional<icd::RunStatus> status() {
    const bool is_there = number() == 1;
    icd::RunStatus status;
    status.score = number();
    status.run_clock = real();
    status.remaining_reports = number();
    status.current_team = text();
    return is_there ? std::optional(status) : std::nullopt;
  }

 private:
  const char* take(std::size_t size) {
    if (size > bytes_.size() - at_) throw std::runtime_error("a record of the ledger is cut");
    at_ += size;
    return bytes_.data() + at_ - size;
  }

  std::string bytes_;
  std::size_t at_ = 0;
};

dispatch::Report report_of(Cursor members) {
  dispatch::Report report;
  report.number = members.number();
  report.report.type = members.text();
  report.report.position.x = members.real();
  report.report.position.y = members.real();
  report.report.position.z = members.real();
  report.report.robot = icd::RobotName::parse(members.text());
  report.sender = members.text();
  report.received = members.real();
  report.changed = members.real();
  report.state = dispatch::state_named(members.text()).value();
  report.note = members.text();
  report.run = members.number();
  report.asked = members.number() == 1;
  report.same_as = members.number();
  report.tries = members.number();
  report.sending = members.number();
  report.sent = members.real();
  report.before = members.status();
  report.status = static_cast<int>(members.number());
  report.content_type = members.text();
  report.answer = members.text();
  report.reconciled = members.number() == 1;
  report.beside = members.number();
  report.counted = members.number() == 1;
  report.uncertain = members.text();
  return report;
}

std::map<std::string, std::string> files_in(const std::string& directory) {
  std::map<std::string, std::string> files;
  for (const auto& file : fs::directory_iterator(directory)) {
    std::ifstream bytes(file.path(), std::ios::binary);
    if (file.is_regular_file()) files[file.path().filename()] = {std::istreambuf_iterator<char>(bytes), {}};
  }
  return files;
}

}  // namespace

bool lacks_records(const std::string& copy, const std::string& directory) {
  const auto older = files_in(copy), newer = files_in(directory);
  return store::read_again(older).last < store::read_again(newer).last ||
         std::ranges::any_of(
             newer,
             [&](const auto& file) { return file.first.starts_with("log-") && !older.contains(file.first); });
}

LedgerReading read_ledger(const std::string& directory) {
  if (!fs::exists(directory)) return {};
  std::map<std::int64_t, dispatch::Report> reports;
  const store::SecondReading read = store::read_again(files_in(directory));
  for (const std::string& body : read.bodies()) {
    Cursor record(body);
    record.number();  // the highest number
    for (std::int64_t left = record.number(); left > 0; --left) {
      dispatch::Report report = report_of(Cursor(record.text()));
      record.text();  // its history
      reports[report.number] = std::move(report);
    }
  }
  LedgerReading all{.reports = {}, .missing = read.missing.size()};
  for (auto& [number, report] : reports) all.reports.push_back(std::move(report));
  return all;
}

}  // namespace adit::simulation
