#pragma once

#include <random>

#include "forward/clocks.hpp"
#include "forward/maps.hpp"
#include "forward/rejected.hpp"
#include "forward/traffic_counts.hpp"
#include "host/folder.hpp"
#include "journal/journal.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "settings/settings.hpp"
#include "spool/spool.hpp"

namespace adit::forward {

/// The surroundings of each part of the flow.
struct FlowParts {
  host::Folder folder_, journal_folder_;
  loop::Loop loop_;
  uplink::Servers servers_{loop_};
  settings::Settings settings_;
  std::mt19937_64 random_{1};
  TrafficCounts counts_{[] {}};
  journal::Journal journal_{loop_, journal_folder_.path()};
};

struct MapsParts : FlowParts {
  host::Folder rejected_folder_;
  spool::Spool spool_{folder_.path()};
  loop::Workers workers_{loop_, 1};
  loop::Writer writer_{loop_};
  RejectedStore rejected_{loop_, writer_, rejected_folder_.path()};

  /// Without a token, maps stay queued.
  Maps maps_with(std::optional<icd::BearerToken> token) {
    return {loop_,     servers_,  workers_,         writer_,
            spool_,    settings_, std::move(token), counts_,
            rejected_, random_,   journal_,         [](const icd::MapUpdate&) {}};
  }
};

struct ScoringParts : FlowParts {
  Clocks clocks_{loop_, journal_, folder_.path()};
  ledger::Ledger ledger_ = std::move(*ledger::Ledger::open(folder_.path()));
};

}  // namespace adit::forward
