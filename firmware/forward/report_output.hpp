#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dispatch/output.hpp"
#include "intake/server.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"

namespace adit::forward {

/// Does what the rules of reports ask for: writes steps to the ledger and the log, answers the clients.
class ReportOutput final : public dispatch::Output {
 public:
  /// What can follow once a report has left, or its client has its answer, follows so soon: Flush::Soon, and
  /// the log.
  static constexpr std::chrono::milliseconds kSoon{2};
  /// While the ledger takes no report it is tried so often.
  static constexpr std::chrono::seconds kTryEvery{5};

  ReportOutput(loop::Loop& loop, ledger::Ledger& ledger);

  /// A client that waits from now on.
  dispatch::ClientId add(std::shared_ptr<intake::Responder> responder);
  /// A client that is told nothing: the operator, who watches the report itself.
  dispatch::ClientId add_nobody() { return ++last_client_; }
  /// What the last one was told, whoever it was.
  const dispatch::ClientAnswer& last_told() const { return last_told_; }

  bool write(std::span<const dispatch::Report> steps, const dispatch::Run* run,
             dispatch::Flush flush) override;
  void tell(dispatch::ClientId client, const dispatch::ClientAnswer& answer,
            const dispatch::Report& report) override;

  /// Why the ledger takes no report, by the last try, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  /// A step as the log tells of it.
  struct Step {
    std::int64_t number;
    std::string type, sender;
    dispatch::ReportState state;
    int status;
    std::string note;
  };
  void follow_up();
  void tried(const ledger::Result<void>& result);

  loop::Loop& loop_;
  ledger::Ledger& ledger_;
  loop::Source follow_up_, try_again_;
  std::vector<Step> unlogged_;
  std::map<dispatch::ClientId, std::shared_ptr<intake::Responder>> clients_;
  dispatch::ClientId last_client_ = 0;
  dispatch::ClientAnswer last_told_;
  std::string trouble_;
};

}  // namespace adit::forward
