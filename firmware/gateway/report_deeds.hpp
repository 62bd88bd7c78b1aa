#pragma once

#include <map>
#include <memory>
#include <string>

#include "dispatch/deeds.hpp"
#include "intake/server.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"

namespace adit::gateway {

/// What the rules of reports want done: steps into the ledger and the log, answers to the clients.
class ReportDeeds final : public dispatch::Deeds {
 public:
  /// How soon Flush::Soon is: once the client has its answer.
  static constexpr std::chrono::milliseconds kSoon{2};

  ReportDeeds(loop::Loop& loop, ledger::Ledger& ledger);

  /// A client that waits from now on.
  dispatch::ClientId add(std::shared_ptr<intake::Responder> responder);

  bool write(std::span<const dispatch::Report> steps, const dispatch::Run* run,
             dispatch::Flush flush) override;
  void tell(dispatch::ClientId client, const dispatch::ClientAnswer& answer,
            const dispatch::Report& report) override;

  /// Why the last write failed, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  void flush();

  loop::Loop& loop_;
  ledger::Ledger& ledger_;
  loop::Source flush_;
  std::map<dispatch::ClientId, std::shared_ptr<intake::Responder>> clients_;
  dispatch::ClientId last_client_ = 0;
  std::string trouble_;
};

}  // namespace adit::gateway
