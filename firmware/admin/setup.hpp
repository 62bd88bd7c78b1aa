#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "admin/factory_reset.hpp"
#include "admin/store.hpp"
#include "api/setup.hpp"

namespace adit::admin {

/// What the gateway runs with, and how that is changed.
class Setup final : public api::Setup {
 public:
  /// What it means for the reports where the scoring endpoint is at this address and port from then on.
  using Meaning = std::function<std::string(const std::string& post)>;

  /// `apply` is called once a change is on the disk, and sees to it that runs_with() is told what came of it;
  /// `restart` ends the gateway, so that another begins. `store` and `reset` outlive this.
  Setup(Store& store, FactoryReset& reset, const Store::Loaded& loaded, std::string trouble,
        Meaning for_reports, std::function<void()> apply, std::function<void()> restart);

  /// A change was applied, or reverted: the gateway runs with these. `trouble`: see api::Setup.
  void runs_with(const Store::Loaded& loaded, std::string trouble);

  const settings::Settings& settings() const override { return settings_; }
  bool saved() const override { return saved_; }
  bool applying() const override { return applying_; }
  const std::string& trouble() const override { return trouble_; }
  std::vector<api::TokenRow> tokens() const override { return tokens_; }
  std::vector<std::string> warnings(const settings::Settings& next) const override;
  icd::Checked<void> save(const settings::Settings& next) override;
  icd::Checked<void> set_token(const std::string& name,
                               const std::optional<icd::BearerToken>& token) override;
  icd::Checked<void> reset() override;

 private:
  /// What `written` has on the disk is brought about by `apply`.
  icd::Checked<void> applied(const std::expected<void, std::string>& written, const char* what,
                             const std::function<void()>& apply);

  Store& store_;
  FactoryReset& reset_;
  settings::Settings settings_;
  bool saved_ = false;
  std::string trouble_;
  std::vector<api::TokenRow> tokens_;
  Meaning for_reports_;
  std::function<void()> apply_, restart_;
  bool applying_ = false;
  bool is_kept_ = true;  // what is run with is what the disk has: not after a save that failed halfway
};

/// The token for an endpoint ("scoring", "mapping"): that of the course in use, or else the common one.
std::optional<icd::BearerToken> token_for(const std::string& endpoint, const settings::Settings& settings,
                                          const host::Secrets& secrets);

}  // namespace adit::admin
