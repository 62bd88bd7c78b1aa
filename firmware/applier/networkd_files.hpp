#pragma once

#include <array>

#include "applier/arp_probe.hpp"
#include "applier/options.hpp"
#include "network/change.hpp"

namespace adit::applier {

/// The numbers as systemd-networkd's files. An interface whose numbers stay as they are is not touched, and
/// no address is taken that somebody else on its network has.
class NetworkdFiles final : public network::Hands {
 public:
  static constexpr std::chrono::seconds kReload{30};

  using Prober = decltype(&probe);

  /// `options` outlives this.
  explicit NetworkdFiles(const Options& options, Prober prober = &probe)
      : options_(options), probe_(prober) {}

  /// Reads what was confirmed last, and makes networkd's folders hold that and nothing else: a power cut or a
  /// kill may have come at any point. An error: they are not as they should be.
  std::expected<void, std::string> settle();
  const std::optional<network::Numbers>& confirmed() const { return confirmed_; }
  /// settle() found a change that nobody had confirmed.
  bool found_a_change() const { return found_a_change_; }

  std::expected<void, std::string> apply(const network::Numbers& numbers) override;
  std::expected<void, std::string> keep(const network::Numbers& numbers) override;
  std::expected<void, std::string> take_back() override;

 private:
  /// One interface's two places, and what would stand there.
  struct Place {
    std::string interface, tried, kept, text;
    std::uint32_t address = 0;
  };
  std::array<Place, 2> places(const network::Numbers& numbers) const;
  std::array<Place, 2> places() const;
  std::string confirmed_file() const { return options_.state + "/confirmed.json"; }
  std::expected<void, std::string> set_aside(const std::string& why) const;
  std::expected<bool, std::string> write_kept(const network::Numbers& numbers) const;
  std::expected<void, std::string> check_unused(const Place& place) const;
  /// Whether any was there.
  std::expected<bool, std::string> remove_tried() const;
  std::expected<void, std::string> reload();

  const Options& options_;
  Prober probe_;
  std::optional<network::Numbers> confirmed_;
  bool found_a_change_ = false;
  bool reload_is_due_ = false;  // the last one failed
};

}  // namespace adit::applier
