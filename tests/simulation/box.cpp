#include "simulation/box.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "gateway/options.hpp"
#include "gateway/service.hpp"
#include "simulation/command_post.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostCrossings = 40;

void write(const fs::path& path, const std::string& text) {
  std::ofstream(path) << text;
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
}

/// Nobody connects to the socket in which the team's server listens: the clients come in by the door.
std::string first_settings() {
  return R"({"version": 1, "command_post": {"scoring": {"address": "10.100.1.200", "port": )" +
         std::to_string(CommandPost::kScoring) + R"(}, "mapping": {"address": "10.100.1.201", "port": )" +
         std::to_string(CommandPost::kMapping) +
         R"(}}, "team": {"listen": [{"address": "127.0.0.1", "port": 0}]}})";
}

/// With their modes; what is no file is left out.
void copy_folder(const fs::path& from, const fs::path& to) {
  fs::create_directory(to, from);
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path there = to / entry.path().filename();
    if (entry.is_directory()) {
      copy_folder(entry.path(), there);
    } else if (entry.is_regular_file()) {
      std::ofstream(there, std::ios::binary) << std::ifstream(entry.path(), std::ios::binary).rdbuf();
      fs::permissions(there, entry.status().permissions());
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
  write(folder_ / "settings.json", first_settings());
}

Box::~Box() {
  std::error_code ignored;
  fs::remove_all(top_, ignored);
}

void Box::live() {
  while (!finished_) one_life();
}

void Box::one_life() {
  gateway::Options options;
  options.settings = folder_ / "settings.json";
  options.secrets = folder_ / "secrets";
  options.state = folder_ / "state";
  options.network = folder_ / "network";
  options.update = folder_ / "update";
  options.notices = folder_ / "notices";
  ::setenv("RUNTIME_DIRECTORY", (folder_ / "runtime").c_str(), 1);
  world_.begin_life();
  try {
    if (gateway::Service(options).run() != 0) std::abort();
  } catch (const Killed&) {
    fs::remove_all(folder_);
    folder_ = next_;
  }
  world_.end_life();
  if (!finished_) world_.run_for(seconds(random_.between(0.05, 2)));
}

void Box::finish() {
  finished_ = true;
  if (world_.on_sigterm) terminate();
}

void Box::terminate() {
  if (world_.is_dead() || !world_.on_sigterm) return;
  world_.note({.kind = Kind::Stops, .what = "aditd", .who = "", .serial = world_.life()});
  world_.on_sigterm();
}

void Box::kill() {
  if (world_.is_dead()) return;
  world_.die_after(random_.below(kMostCrossings), [this] { died(); });
}

/// The files as they are at this instant are the next life's: what the objects of this one still write goes
/// to the old ones.
void Box::died() {
  next_ = top_ / std::to_string(++folders_);
  copy_folder(folder_, next_);
}

}  // namespace adit::simulation
