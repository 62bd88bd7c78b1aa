#pragma once

#include <random>

#include "forward/clocks.hpp"
#include "forward/record.hpp"
#include "forward/rejected.hpp"
#include "host/folder.hpp"
#include "journal/journal.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "settings/settings.hpp"
#include "spool/spool.hpp"

namespace adit::forward {

/// What each part of the flow stands among.
struct Around {
  host::Folder folder_, journal_folder_;
  loop::Loop loop_;
  settings::Settings settings_;
  std::mt19937_64 random_{1};
  Record record_{[] {}};
  journal::Journal journal_{loop_, journal_folder_.path()};
};

struct AroundMaps : Around {
  host::Folder rejected_folder_;
  spool::Spool spool_{folder_.path()};
  loop::Workers workers_{loop_, 1};
  loop::Writer writer_{loop_};
  RejectedStore rejected_{loop_, writer_, rejected_folder_.path()};
};

struct AroundScoring : Around {
  Clocks clocks_{loop_, journal_, folder_.path()};
  ledger::Ledger ledger_ = std::move(*ledger::Ledger::open(folder_.path()));
};

}  // namespace adit::forward
