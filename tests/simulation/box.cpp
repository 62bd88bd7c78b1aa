#include "simulation/box.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <utility>
#include <vector>

#include "admin/kept_file.hpp"
#include "gateway/options.hpp"
#include "gateway/service.hpp"
#include "loop/file_descriptor.hpp"
#include "settings/settings.hpp"
#include "simulation/command_post.hpp"
#include "simulation/ledger_reading.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestMap = 64u << 10;  // of a robot or a flood
constexpr std::size_t kLargeMap = 4u << 20;     // in a world of large maps
constexpr std::uint64_t kRightThen = 4, kSoon = 40, kMostCrossings = 400;
constexpr double kDiesInExec = 0.3;
constexpr const char* kCopy = "ledger";  // beside the box's directories
/// Seconds until a killed process is restarted, and until a machine without power is booted.
constexpr double kRestart[] = {0.05, 2}, kBoot[] = {5, 20};

void write(const fs::path& path, const std::string& text) {
  std::ofstream(path) << text;
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
}

/// Some queues are so small that they fill up and messages are split.
struct Queues {
  std::string settings;
  std::size_t most_map_bytes;  // queued; plus two maps that are queued again
};

Queues queues(Random random, std::size_t largest_map) {
  Queues queues;
  const settings::Settings usual;
  std::size_t map_bytes = usual.queues.map_bytes, merge_bytes = usual.queues.merge_bytes;
  queues.settings =
      R"("markers_per_message": )" + std::to_string(random.chance(0.3) ? 1 + random.uniform_index(4) : 2000);
  if (random.chance(0.3)) map_bytes = 1u << 20;
  if (random.chance(0.3)) merge_bytes = random.chance(0.5) ? 0 : 4000;
  queues.settings += R"(, "map_bytes": )" + std::to_string(map_bytes);
  queues.settings += R"(, "merge_bytes": )" + std::to_string(merge_bytes);
  if (random.chance(0.2)) queues.settings += R"(, "marker_bytes_per_message": 1024)";
  queues.most_map_bytes = map_bytes + 2 * (merge_bytes + largest_map);
  return queues;
}

/// In some worlds Adit rounds the first robots' clouds.
std::string robots(Random random) {
  constexpr int kNamed = 4;
  if (!random.chance(0.3)) return "";
  std::string list;
  for (int i = 1; i <= kNamed; ++i) {
    if (!list.empty()) list += ", ";
    list += R"({"name": "R)" + std::to_string(i) + R"(", "precision": "1mm"})";
  }
  return R"(, "robots": [)" + list + "]";
}

/// No client connects to the listening socket: the clients come in through the door (door.hpp).
/// `is_one_server`: both endpoints have one address and port.
std::string first_settings(const std::string& queues, const std::string& robots, const std::string& interface,
                           bool is_one_server) {
  const std::string mapping =
      std::to_string(is_one_server ? CommandPost::kScoring : CommandPost::kMapping) + R"(})";
  const char* const host = is_one_server ? "200" : "201";
  return R"({"version": 1, "command_post": {"scoring": {"address": "10.100.1.200", "port": )" +
         std::to_string(CommandPost::kScoring) + R"(}, "mapping": {"address": "10.100.1.)" + host +
         R"(", "port": )" + mapping + R"(, "interface": ")" + Box::kInterface +
         R"("}, "courses": [{"name": "B", "scoring": {"address": "10.100.2.200", "port": )" +
         std::to_string(CommandPost::kScoring) + R"(}, "mapping": {"address": "10.100.2.)" + host +
         R"(", "port": )" + mapping +
         R"(}], "team": {"listen": [{"address": "127.0.0.1", "port": 0}], "connections": 64, "connections_per_address": 8, "interface": ")" +
         interface + R"("}, "queues": {)" + queues + "}" + robots + "}";
}

/// Copies the mode and the holes too.
void copy_one(const fs::path& from, const fs::path& to) {
  const loop::FileDescriptor source(::open(from.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat found{};
  if (::fstat(source.get(), &found) != 0) std::abort();
  const loop::FileDescriptor copy(
      ::open(to.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, found.st_mode & 07777));
  bool well = ::ftruncate(copy.get(), found.st_size) == 0;
  for (off_t at = 0; well && (at = ::lseek(source.get(), at, SEEK_DATA)) >= 0;) {
    std::vector<char> bytes(static_cast<std::size_t>(::lseek(source.get(), at, SEEK_HOLE) - at));
    const auto size = static_cast<ssize_t>(bytes.size());
    well = ::pread(source.get(), bytes.data(), bytes.size(), at) == size &&
           ::pwrite(copy.get(), bytes.data(), bytes.size(), at) == size;
    at += size;
  }
  if (!well) std::abort();
}

/// Copies directories and regular files only.
void copy_folder(const fs::path& from, const fs::path& to) {
  fs::create_directory(to, from);
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path there = to / entry.path().filename();
    if (entry.is_directory()) {
      copy_folder(entry.path(), there);
    } else if (entry.is_regular_file()) {
      copy_one(entry.path(), there);
    }
  }
}

}  // namespace

Box::Box(World& world) : world_(world), random_(world.random("box")) {
  std::string name = "/dev/shm/adit-simulation-XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) std::abort();
  top_ = name;
  folder_ = top_ / "0";
  for (const char* each : {"state", "runtime", "secrets", "network", "update"})
    fs::create_directories(folder_ / each);
  fs::permissions(folder_ / "secrets", fs::perms::owner_all);
  for (const char* each : {"scoring", "mapping"})
    write(folder_ / "secrets" / (std::string(each) + ".token"), "flux230{showroom\n");
  write(folder_ / "secrets" / "team.token", "token-of-the-team\n");
  const std::string interface = world.random("the team's interface").chance(0.5) ? kInterface : "";
  world.door().belongs_to(interface);
  const auto [queues, most_map_bytes] =
      simulation::queues(world.random("settings"), world.has_large_maps() ? kLargeMap : kLargestMap);
  most_map_bytes_ = most_map_bytes;
  write(folder_ / "settings.json", first_settings(queues, simulation::robots(world.random("precision")),
                                                  interface, world.random("one server").chance(0.3)));
  world_.disk().mount(folder_);
}

Box::~Box() {
  std::error_code ignored;
  fs::remove_all(top_, ignored);
}

void Box::live() {
  while (!finished_ || starts_again_) run_process();
}

void Box::run_process() {
  gateway::Options options;
  options.settings = folder_ / "settings.json";
  options.secrets = folder_ / "secrets";
  options.state = folder_ / "state";
  options.network = folder_ / "network";
  options.clock = folder_ / "clock";
  options.update = folder_ / "update";
  options.notices = folder_ / "notices";
  options.block = folder_ / "block";
  if (is_copy_due_ && !starts_again_) replace_ledger();
  ::setenv("RUNTIME_DIRECTORY", (folder_ / "runtime").c_str(), 1);
  world_.begin_process(std::exchange(starts_again_, false));
  world_.note(
      {.actor = Actor::Disk, .kind = Kind::Serves, .what = "settings", .who = world_.disk().settings()});
  if (const auto how = std::exchange(dies_at_start_, std::nullopt)) die_soon(*how);
  try {
    const bool began = gateway::Service(options, nullptr).run([](const char*) noexcept { return 0; }) == 0;
    if (!began && !world_.is_dead()) world_.note({.kind = Kind::Fails, .what = "aditd", .who = ""});
  } catch (const Killed&) {
  } catch (const StartsAgain&) {
    starts_again_ = true;
    const auto how = random_.chance(0.5) ? World::How::Killed : World::How::PowerCut;
    if (random_.chance(kDiesInExec) && !world_.omits("death in exec")) die(how);
  }
  if (world_.is_dead()) {
    fs::remove_all(folder_);
    folder_ = next_;
    world_.disk().mount(folder_);
  }
  world_.end_process();
  if (boots_) starts_again_ = false;  // the power was cut during exec
  if (starts_again_) return;
  const auto& [least, most] = std::exchange(boots_, false) ? kBoot : kRestart;
  if (!finished_) world_.run_for(seconds(random_.uniform(least, most)));
}

void Box::finish() {
  finished_ = true;
  if (world_.on_sigterm) terminate();
}

void Box::terminate() {
  world_.when_moving([this] {
    if (world_.is_dead() || !world_.on_sigterm) return;
    world_.note({.kind = Kind::Stops, .what = "aditd", .who = "", .serial = world_.process()});
    world_.on_sigterm();
  });
}

void Box::die(World::How how) {
  if (!world_.is_dead()) return die_soon(how);
  dies_at_start_ = how;
}

void Box::copy_ledger() {
  world_.disk().look_on([this] {
    const fs::path ledger = folder_ / Disk::kLedger, copy = top_ / kCopy;
    if (!fs::exists(ledger)) return;
    fs::remove_all(copy);
    copy_folder(ledger, copy);
    has_copy_ = true;
    world_.note({.actor = Actor::Disk, .kind = Kind::Copied, .what = "ledger", .who = ""});
  });
}

void Box::put_ledger_back() {
  is_copy_due_ = has_copy_;
}

/// The person syncs what he copies.
void Box::replace_ledger() {
  has_copy_ = is_copy_due_ = false;
  const fs::path ledger = folder_ / Disk::kLedger, copy = top_ / kCopy;
  const bool lacks = fs::exists(ledger) && lacks_records(copy, ledger);
  fs::remove_all(ledger);
  fs::rename(copy, ledger);
  world_.disk().ledger_replaced();
  world_.note(
      {.actor = Actor::Disk, .kind = Kind::PutBack, .what = "ledger", .who = "", .serial = lacks ? 1 : 0});
}

void Box::die_soon(World::How how) {
  const auto dies = [this, how] { how == World::How::PowerCut ? lost_power() : died(); };
  if (random_.chance(0.25)) return world_.die_after_report(random_.uniform_index(kRightThen), how, dies);
  world_.die_after(random_.uniform_index(random_.chance(0.5) ? kSoon : kMostCrossings), how, dies);
}

/// The next process starts from the files as they are now. Later writes by objects of the dead process go
/// to the old files.
void Box::died() {
  next_ = top_ / std::to_string(++folders_);
  copy_folder(folder_, next_);
}

/// Memory is lost, except the sessions: as if the operator had logged in again. The clock of some machines
/// runs on without power, others start at a fixed time.
void Box::lost_power() {
  died();
  world_.note({.kind = Kind::PowerCut, .what = "", .who = "", .serial = world_.process()});
  world_.disk().cut_power(next_);
  const fs::path runtime = next_ / Disk::kRuntime;
  const fs::path sessions = folder_ / Disk::kRuntime / admin::SessionKeeper::kFile;
  fs::remove_all(runtime);
  fs::create_directory(runtime);
  if (fs::exists(sessions)) fs::copy_file(sessions, runtime / admin::SessionKeeper::kFile);
  if (random_.chance(0.5)) world_.set_clock(-world_.time());
  boots_ = true;
}

}  // namespace adit::simulation
