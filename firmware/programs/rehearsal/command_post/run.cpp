#include "rehearsal/command_post/run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>

#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::rehearsal {

namespace {

constexpr double kScoringDistance = 5.0;  // metres, by the competition's rules

std::optional<Artifact> artifact_of(std::string_view line) {
  if (std::ranges::count(line, ',') != 3) return std::nullopt;
  const std::string type(icd::trim(icd::cut(line, ',')));
  const auto metres = [&line] {
    constexpr double most = std::numeric_limits<double>::max();
    return number_of(icd::trim(icd::cut(line, ',')), -most, most);
  };
  const auto x = metres(), y = metres(), z = metres();
  if (!is_artifact_type(type) || !x || !y || !z) return std::nullopt;
  return Artifact{type, {*x, *y, *z}};
}

/// Claims the nearest unclaimed artifact of that type (in any letter case) within 5 m. False: there is none.
bool claim(std::vector<Artifact>& artifacts, std::string_view type, const Vector3& position) {
  Artifact* nearest = nullptr;
  double least = kScoringDistance;
  for (Artifact& artifact : artifacts) {
    const double distance = std::hypot(artifact.position.x - position.x, artifact.position.y - position.y,
                                       artifact.position.z - position.z);
    if (artifact.claimed || distance > least || !icd::equals_ignoring_case(artifact.type, type)) continue;
    nearest = &artifact;
    least = distance;
  }
  if (nearest != nullptr) nearest->claimed = true;
  return nearest != nullptr;
}

/// "1" is followed by "2", "1.5.9" by "1.5.10", "practice" by "practice-2".
std::string id_after(std::string id) {
  const std::size_t at = id.find_last_not_of("0123456789") + 1;  // npos + 1 is 0
  if (at == id.size()) return id + "-2";
  for (std::size_t digit = id.size(); digit-- > at;) {
    if (id[digit] != '9') {
      ++id[digit];
      return id;
    }
    id[digit] = '0';
  }
  return id.insert(at, 1, '1');
}

}  // namespace

std::expected<std::vector<Artifact>, std::string> read_artifacts(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) return std::unexpected(path + ": cannot be read");
  if (icd::trim(line) != "type,x,y,z") return std::unexpected(path + ":1: expected the header type,x,y,z");
  std::vector<Artifact> artifacts;
  for (int number = 2; std::getline(file, line); ++number) {
    if (icd::trim(line).empty()) continue;
    auto artifact = artifact_of(line);
    if (!artifact) {
      return std::unexpected(icd::sentence(
          path, ":", number, ": expected an artifact type and three numbers, as in Cell Phone,1.5,-2,0"));
    }
    artifacts.push_back(std::move(*artifact));
  }
  return artifacts;
}

Run::State Run::state_at(Clock::time_point now) const {
  if (ended_) return State::Ended;
  if (!started_) return State::NotStarted;
  if (now - *started_ > plan_.length) return State::Ended;
  return stopped_ ? State::AdminStop : State::Running;
}

double Run::clock_at(Clock::time_point now) const {
  if (!started_) return 0;
  const double seconds = std::chrono::duration<double>(now - *started_).count();
  return std::round(seconds * 1000) / 1000;
}

bool Run::change(Change change, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  const State state = state_at(now);
  const bool is_allowed = change == Change::Start    ? state == State::NotStarted
                          : change == Change::Stop   ? state == State::Running
                          : change == Change::Resume ? state == State::AdminStop
                                                     : state != State::Ended;
  if (!is_allowed) return false;
  if (change == Change::Start) started_ = now;
  if (change == Change::End) ended_ = true;
  stopped_ = change == Change::Stop;
  return true;
}

void Run::restart(const NewRun& wanted, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (wanted.id || plan_.renames) plan_.id = wanted.id ? *wanted.id : id_after(plan_.id);
  if (wanted.team) plan_.team = *wanted.team;
  started_.reset();
  if (wanted.started) started_ = now;
  stopped_ = false;
  ended_ = false;
  score_ = 0;
  used_ = granted_ = 0;
  scored_.clear();
  for (Artifact& artifact : artifacts_) artifact.claimed = false;
}

std::string Run::rename() {
  const std::lock_guard lock(mutex_);
  return plan_.id = id_after(plan_.id);
}

std::int64_t Run::grant() {
  const std::lock_guard lock(mutex_);
  return plan_.reports + ++granted_ - used_;
}

Run::Standing Run::standing(Clock::time_point now) const {
  constexpr std::array<const char*, 4> kStates = {"not started", "running", "admin stop", "ended"};
  const std::lock_guard lock(mutex_);
  return {plan_.team,    plan_.id, kStates.at(static_cast<std::size_t>(state_at(now))),
          clock_at(now), score_,   plan_.reports + granted_ - used_};
}

Run::Ruling Run::submit(const std::string& type, const std::optional<Vector3>& position,
                        Clock::time_point now) {
  constexpr std::array<const char*, 4> kStatuses = {"run not started", "scored", "admin stop",
                                                    "time limit exceeded"};
  const std::lock_guard lock(mutex_);
  const State state = state_at(now);
  Ruling ruling{
      ++last_id_, plan_.team, plan_.id, clock_at(now), kStatuses.at(static_cast<std::size_t>(state)), 0};
  if (state != State::Running) return ruling;
  if (used_ >= plan_.reports + granted_) {
    ruling.status = "report limit exceeded";
    return ruling;
  }
  ++used_;
  if (position) {
    const auto [first, is_new] =
        scored_.try_emplace({lower(type), position->x, position->y, position->z}, ruling.id);
    if (!is_new) ruling.repeats = first->second;
  }
  if (position && claim(artifacts_, type, *position)) {
    ruling.score_change = 1;
    ++score_;
  }
  return ruling;
}

}  // namespace adit::rehearsal
