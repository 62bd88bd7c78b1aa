#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "admin/factory_reset.hpp"
#include "admin/store.hpp"
#include "api/setup.hpp"

namespace adit::admin {

/// The gateway's settings and tokens, and their changes.
class Setup final : public api::Setup {
 public:
  /// Returns the effect on reports of a scoring endpoint at this address and port.
  using Meaning = std::function<std::string(const std::string& post)>;

  /// `apply` is called after a change is on disk, and must cause set_running(). `restart` replaces the
  /// gateway. `store` and `reset` must outlive this object.
  Setup(Store& store, FactoryReset& reset, const Store::LoadedSettings& loaded, std::string trouble,
        Meaning for_reports, std::function<void()> apply, std::function<void()> restart);

  /// Reports the configuration in use after a change was applied or reverted. `trouble`: see api::Setup.
  void set_running(const Store::LoadedSettings& loaded, std::string trouble);

  const settings::Settings& settings() const override { return settings_; }
  bool is_saved() const override { return saved_; }
  bool applying() const override { return applying_; }
  const std::string& trouble() const override { return trouble_; }
  std::vector<api::TokenRow> tokens() const override { return tokens_; }
  std::vector<std::string> warnings(const settings::Settings& next) const override;
  icd::Checked<void> save(const settings::Settings& next) override;
  icd::Checked<void> set_token(const std::string& name,
                               const std::optional<icd::BearerToken>& token) override;
  icd::Checked<void> reset() override;

 private:
  /// Calls `apply` if `written` is good. `what`: for the error.
  icd::Checked<void> apply_if_written(const std::expected<void, std::string>& written, const char* what,
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
  bool is_kept_ = true;  // the disk matches the configuration in use; false after an incomplete save
};

/// The token for an endpoint ("scoring", "mapping"): the present course's, or else the common one.
std::optional<icd::BearerToken> token_for(const std::string& endpoint, const settings::Settings& settings,
                                          const host::Secrets& secrets);

}  // namespace adit::admin
