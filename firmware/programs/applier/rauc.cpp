#include "applier/rauc.hpp"

#include <chrono>
#include <string_view>
#include <thread>

#include "host/output.hpp"
#include "host/service.hpp"
#include "update/health.hpp"

namespace adit::applier {
namespace {

/// Longest wait for the client of an installation. A slow card takes some minutes. If the client dies or
/// takes longer, status() waits for RAUC itself.
constexpr std::chrono::minutes kInstall{20};
constexpr std::chrono::seconds kRaucAnswer{60};
/// Interval of questions while RAUC is busy.
constexpr std::chrono::seconds kAgain{1};

using update::Fault;

Fault fault_of(const host::Output& said) {
  Fault fault = update::fault_in(said.out, said.err);
  if (fault.sentence.empty()) fault.sentence = "rauc: " + said.trouble;
  return fault;
}

std::expected<std::string, Fault> ask(const std::vector<std::string>& words) {
  host::Output said = host::output_of(words, kRaucAnswer);
  Fault fault = fault_of(said);
  // A success with a "busy" warning lacks the next slot.
  if (!said.trouble.empty() || fault.kind == Fault::Kind::Busy) return std::unexpected(std::move(fault));
  return std::move(said.out);
}

std::expected<void, std::string> mark(const std::string& command, const char* how, const char* slot) {
  if (const auto said = ask({command, "status", how, slot}); !said)
    return std::unexpected(said.error().sentence);
  return {};
}

}  // namespace

std::string version_in(const std::string& path) {
  const auto text = host::read_file(path);
  std::string value(text ? update::value_of("VERSION_ID", *text) : "");
  std::erase(value, '"');
  return value;
}

std::expected<update::Running, std::string> Rauc::status() const {
  const auto until = std::chrono::steady_clock::now() + kInstall;
  const std::vector<std::string> words = {command_, "status", "--output-format=json"};
  auto said = ask(words);
  while (!said && said.error().kind == Fault::Kind::Busy && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(kAgain);
    said = ask(words);
  }
  if (!said) return std::unexpected(said.error().sentence);
  return update::read_status(*said);
}

std::expected<update::Bundle, std::string> Rauc::info(const std::string& bundle) const {
  const auto said = ask({command_, "info", "--output-format=json", bundle});
  if (!said) return std::unexpected(said.error().sentence);
  return update::read_info(*said);
}

std::expected<void, std::string> Rauc::install(const std::string& bundle,
                                               const std::function<void(int)>& progress) const {
  const host::Output said = host::output_of({command_, "install", "--progress", bundle}, kInstall,
                                            [&progress](std::string_view line) {
                                              if (const auto percent = update::percent_in(line))
                                                progress(*percent);
                                            });
  if (said.trouble.empty()) return {};
  return std::unexpected(fault_of(said).sentence);
}

std::expected<void, std::string> Rauc::mark_good() const {
  return mark(command_, "mark-good", "booted");
}

std::expected<void, std::string> Rauc::start_other_next() const {
  if (auto first = mark(command_, "mark-active", "other"); !first) return first;
  return mark(command_, "mark-good", "other");
}

std::expected<void, std::string> Rauc::start_booted_next() const {
  return mark(command_, "mark-active", "booted");
}

/// A slot marked bad leaves the boot loader's order. Otherwise the boot loader would try it three more times
/// once no slot has tries left.
std::expected<void, std::string> Rauc::leave_other() const {
  if (auto first = start_booted_next(); !first) return first;
  return mark(command_, "mark-bad", "other");
}

}  // namespace adit::applier
