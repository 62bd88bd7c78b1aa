#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "gateway/channel.hpp"
#include "gateway/record.hpp"
#include "gateway/spool.hpp"
#include "gateway/uri_pace.hpp"
#include "icd/map_update.hpp"
#include "icd/status.hpp"
#include "lanes/map_lane.hpp"
#include "lanes/stamps.hpp"
#include "loop/workers.hpp"

namespace adit::gateway {

/// Maps on their way to the mapping endpoint: wait in their lane, are packed on a worker, and go out one at a
/// time on a connection of their own, paced within the link's budget.
class Maps {
 public:
  /// `taken` is given each map that the Command Post took.
  Maps(loop::Loop& loop, loop::Workers& workers, const Spool& spool, const settings::Settings& settings,
       std::optional<icd::BearerToken> token, Record& record, std::mt19937_64& random,
       std::function<void(icd::MapUpdate)> taken);

  /// As if something had just been sent, by whoever sent before.
  void hold_back() { pace_.sent(loop_.now()); }
  /// A map that the spool kept under this number.
  void restore(std::uint64_t number, icd::MapUpdate update);

  /// `update`'s stamp is on the gateway's clock. Refused with 429 where the queue is full.
  icd::Checked<void> take(icd::MapUpdate update, std::size_t bytes_received);

  /// Sends nothing more. False while an answer is awaited or a map is not yet kept.
  bool stop();
  /// The cable is: nothing waits any more for what failed without it.
  void link_is_back();

  bool packing() const { return preparing_; }
  const Channel& channel() const { return channel_; }
  std::size_t queued_bytes() const { return lane_.bytes(); }
  bool nearly_full() const { return lane_.bytes() > settings_.queues.map_bytes / 5 * 4; }
  std::size_t waiting(const Traffic& traffic) const;

 private:
  /// A map out of the lane, in the form that goes upstream.
  struct Prepared {
    lanes::WaitingMap waiting;
    icd::ChunkedBytes body;
  };

  std::vector<std::uint64_t> add(std::uint64_t number, icd::MapUpdate update);
  void keep(std::uint64_t number, const icd::MapUpdate& update, std::vector<std::uint64_t> replaced);
  void forget(const std::vector<std::uint64_t>& numbers);
  void done();
  void pump();
  void prepare();
  void send();
  void answered(uplink::Outcome outcome);
  void verdict(const uplink::Answered& answered);
  void again();
  void give_up(int status, const std::string& sentence);

  loop::Loop& loop_;
  loop::Workers& workers_;
  const Spool& spool_;
  const settings::Settings& settings_;
  Record& record_;
  std::function<void(icd::MapUpdate)> taken_;
  Channel channel_;
  UriPace pace_;
  loop::Source wake_;

  lanes::MapLane lane_;
  lanes::StampOrder stamps_;
  std::uint64_t numbers_ = 0;
  std::set<std::uint64_t> needed_;  // maps that must be kept until they are taken
  int being_kept_ = 0;
  bool preparing_ = false;
  loop::Duration packing_took_{0};
  std::shared_ptr<Prepared> prepared_;  // while it is packed, waits for its time, or is under way
  std::uint64_t tried_ = 0;             // the number of the map that `tries_` counts for
  int tries_ = 0;
  bool stopping_ = false;
};

}  // namespace adit::gateway
