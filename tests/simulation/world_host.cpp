// Implements host/interfaces.hpp, host/log.hpp, host/process.hpp, host/random.hpp and host/service.hpp's
// carrier() in the simulated world.
#include "host/interfaces.hpp"
#include "host/log.hpp"
#include "host/log_line.hpp"
#include "host/process.hpp"
#include "host/random.hpp"
#include "host/service.hpp"
#include "simulation/world.hpp"

namespace adit::host {
namespace {

using simulation::World;

Memory& memory() {
  static Memory records;
  return records;
}

void say(Level level, std::string_view message, std::span<const Field> fields) {
  World& world = World::current();
  if (world.is_dead()) return;
  simulation::Event event;
  event.text = std::string(name_of(level)) + ": " + sentence(message, fields);
  world.note(std::move(event));
}

}  // namespace

void log(Level level, std::string_view message, std::initializer_list<Field> fields) {
  if (level > Level::Info) return;
  memory().keep(World::current().stamp(), level, message, fields);
  say(level, message, fields);
}

void log_to_console(Level level, std::string_view message, std::initializer_list<Field> fields) {
  memory().keep(World::current().stamp(), level, message, {});
  say(level, message, fields);
}

/// No check looks for secrets in the log.
void keep_out_of_log(icd::Redaction) {}
std::string strip_secrets(std::string text) {
  return text;
}

std::vector<Record> records_after(std::uint64_t after) {
  return memory().records_after(after);
}

std::uint64_t last_record_number() {
  return memory().last();
}

std::string line_of(const Record& record) {
  const std::vector<Field> fields(record.fields.begin(), record.fields.end());
  return plain_line(time_text(record.at), record.level, record.message, fields);
}

/// All cables are plugged in.
std::optional<bool> carrier(const std::string&) {
  return true;
}
loop::FileDescriptor link_changes() {
  return {};
}
bool take_link_changes(const loop::FileDescriptor&) {
  return false;
}

/// Constant, so that runs are the same on every machine.
Process process() {
  return {};
}
std::string kernel() {
  return "";
}
std::string model() {
  return "";
}

void fill_random(std::span<std::uint8_t> bytes) {
  World& world = World::current();
  simulation::Random random = world.random("random " + std::to_string(world.entropy()));
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
}

}  // namespace adit::host
