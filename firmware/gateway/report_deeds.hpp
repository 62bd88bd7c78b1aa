#pragma once

#include <map>
#include <memory>
#include <string>

#include "dispatch/deeds.hpp"
#include "intake/server.hpp"
#include "ledger/ledger.hpp"

namespace adit::gateway {

/// What the rules of reports want done: steps into the ledger and the log, answers to the clients.
class ReportDeeds final : public dispatch::Deeds {
 public:
  explicit ReportDeeds(ledger::Ledger& ledger) : ledger_(ledger) {}

  /// A client that waits from now on.
  dispatch::ClientId add(std::shared_ptr<intake::Responder> responder);

  bool write(std::span<const dispatch::Report> steps, const dispatch::Run* run) override;
  void tell(dispatch::ClientId client, const dispatch::ClientAnswer& answer,
            const dispatch::Report& report) override;

  /// Why the last write failed, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  ledger::Ledger& ledger_;
  std::map<dispatch::ClientId, std::shared_ptr<intake::Responder>> clients_;
  dispatch::ClientId last_client_ = 0;
  std::string trouble_;
};

}  // namespace adit::gateway
