#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "simulation/faults.hpp"
#include "simulation/http.hpp"
#include "simulation/messages.hpp"
#include "simulation/network.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

/// Both endpoints of a Command Post by the letter of the ICD, with the faults of one run. It records whatever
/// reaches it, and cannot tell a report from the same one again.
class CommandPost final : public Host {
 public:
  static constexpr std::uint16_t kScoring = 8000, kMapping = 8001;  // ports

  /// `world` outlives this.
  CommandPost(World& world, double trouble_for);

  const Faults& faults() const { return faults_; }
  /// No fault begins any more.
  void calm();

  std::optional<int> connecting(const uplink::Endpoint& endpoint) override;
  std::unique_ptr<Peer> connected(const uplink::Endpoint& endpoint, Link& link) override;

 private:
  class Conversation;
  void asked(const HttpMessage& request, Link& link);
  void misbehave(Fault fault, const HttpMessage& request, Link& link);
  /// Records what the request says: its answer.
  std::string take(const HttpMessage& request);
  std::string status() const;
  std::string record(const Item& item);
  void take_later(const HttpMessage& request, double within);
  void begin_run();
  void plan_periods(Fault fault, double trouble_for);
  void note(Fault fault, const std::string& path);

  World& world_;
  Faults faults_;
  Random random_;
  bool calm_ = false;
  bool storm_ = false, polite_ = false, refused_ = false, deaf_ = false;
  std::int64_t run_ = 1, remaining_ = 25, score_ = 0, id_ = 0;
  double run_began_;
  int statuses_ = 0;  // that were answered
};

}  // namespace adit::simulation
