#include "rehearsal/robots/posted.hpp"

#include <nlohmann/json.hpp>

namespace adit::robots {

void Posted::note(const std::string& robot, Kind kind, const Amount& amount) {
  const std::scoped_lock lock(mutex_);
  amounts_[{robot, kind}] = amount;
}

void Posted::note(const std::string& robot, const std::vector<Marker>& standing) {
  const std::scoped_lock lock(mutex_);
  standing_[robot] = standing;
}

std::string Posted::json() const {
  const std::scoped_lock lock(mutex_);
  auto all = nlohmann::json::array();
  for (const auto& [source, posted] : amounts_) {
    all.push_back({{"robot", source.first},
                   {"kind", name_of(source.second)},
                   {"amount", posted.amount},
                   {"places", posted.places},
                   {"newest", posted.newest.time_since_epoch().count()}});
  }
  for (const auto& [robot, markers] : standing_) {
    auto standing = nlohmann::json::array();
    for (const Marker& marker : markers)
      standing.push_back({{"ns", marker.ns}, {"id", marker.id}, {"x", marker.position.x}});
    all.push_back({{"robot", robot}, {"kind", "markers"}, {"standing", std::move(standing)}});
  }
  return all.dump();
}

std::string arrivals_of(const Posted& posted, const Endpoint& control) {
  constexpr std::chrono::seconds kLongest{5};
  const auto reply = Connection(control, {})
                         .exchange({.method = "POST",
                                    .target = "/posted",
                                    .fields = {{"Content-Type", "application/json"}},
                                    .body = posted.json()},
                                   kLongest);
  if (!reply) return "--control: " + reply.error() + "\n";
  const auto answer = nlohmann::json::parse(reply->body, nullptr, false);
  if (reply->status != 200 || !answer.is_object() || !answer.contains("table") ||
      !answer["table"].is_string())
    return "--control: the server is not a control port of adit-rehearsal\n";
  return answer["table"];
}

}  // namespace adit::robots
