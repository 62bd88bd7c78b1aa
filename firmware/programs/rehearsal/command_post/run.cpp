#include "rehearsal/command_post/run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>

#include "rehearsal/command_post/fields.hpp"

namespace adit::rehearsal {

namespace {

constexpr double kScoringDistance = 5.0;  // metres, by the competition's rules

bool same_letters(std::string_view a, std::string_view b) {
  return lower(std::string(a)) == lower(std::string(b));
}

std::optional<Artifact> artifact_of(std::string_view line) {
  std::array<std::string_view, 4> cells;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto comma = line.find(',');
    if ((comma == std::string_view::npos) != (i + 1 == cells.size())) return std::nullopt;
    cells[i] = trimmed(line.substr(0, comma));
    line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
  }
  constexpr double most = std::numeric_limits<double>::max();
  const auto x = number_of(cells[1], -most, most), y = number_of(cells[2], -most, most),
             z = number_of(cells[3], -most, most);
  if (!is_artifact_type(cells[0]) || !x || !y || !z) return std::nullopt;
  return Artifact{std::string(cells[0]), {*x, *y, *z}};
}

}  // namespace

std::expected<std::vector<Artifact>, std::string> read_artifacts(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) return std::unexpected(path + ": cannot be read");
  if (trimmed(line) != "type,x,y,z") return std::unexpected(path + ":1: expected the header type,x,y,z");
  std::vector<Artifact> artifacts;
  for (int number = 2; std::getline(file, line); ++number) {
    if (trimmed(line).empty()) continue;
    auto artifact = artifact_of(line);
    if (!artifact) {
      return std::unexpected(path + ":" + std::to_string(number) +
                             ": expected an artifact type and three numbers, as in Cell Phone,1.5,-2,0");
    }
    artifacts.push_back(std::move(*artifact));
  }
  return artifacts;
}

bool claim(std::vector<Artifact>& artifacts, std::string_view type, const Point& position) {
  Artifact* nearest = nullptr;
  double least = kScoringDistance;
  for (Artifact& artifact : artifacts) {
    const double distance = std::hypot(artifact.position.x - position.x, artifact.position.y - position.y,
                                       artifact.position.z - position.z);
    if (artifact.claimed || distance > least || !same_letters(artifact.type, type)) continue;
    nearest = &artifact;
    least = distance;
  }
  if (nearest != nullptr) nearest->claimed = true;
  return nearest != nullptr;
}

namespace {

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

void Run::begin_again(const NewRun& wanted, Clock::time_point now) {
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

std::int64_t Run::grant(Clock::time_point now) {
  {
    const std::lock_guard lock(mutex_);
    ++granted_;
  }
  return standing(now).remaining_reports;
}

Run::Standing Run::standing(Clock::time_point now) const {
  constexpr std::array<const char*, 4> kStates = {"not started", "running", "admin stop", "ended"};
  const std::lock_guard lock(mutex_);
  return {plan_.team,    plan_.id, kStates.at(static_cast<std::size_t>(state_at(now))),
          clock_at(now), score_,   plan_.reports + granted_ - used_};
}

Run::Ruling Run::submit(const std::string& type, const std::optional<Point>& position,
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
