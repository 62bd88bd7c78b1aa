#pragma once

#include <array>
#include <vector>

#include "applier/arp_probe.hpp"
#include "applier/options.hpp"
#include "applier/reload.hpp"
#include "network/change.hpp"

namespace adit::applier {

/// The numbers as systemd-networkd's files. An interface whose numbers stay as they are is not touched, and
/// no address is taken that somebody else on its network has.
class NetworkdFiles final : public network::Hands {
 public:
  using Prober = decltype(&probe);

  /// `options` outlives this.
  explicit NetworkdFiles(const Options& options, Prober prober = &probe)
      : options_(options), probe_(prober), reload_(options) {}

  /// Reads what was confirmed last, or else what the box came with, and makes networkd's folder hold that and
  /// nothing else, and networkd read it: a kill may have come at any point. An error: it is not as it should
  /// be.
  std::expected<void, std::string> settle();
  /// The same before networkd is there. What cannot be read is no reason to be without any address: then it
  /// is what the box came with.
  std::expected<void, std::string> write_at_start();
  /// What was confirmed last, or what the box came with.
  const std::optional<network::Numbers>& kept() const { return kept_; }
  const network::Endpoints& endpoints() const { return endpoints_; }
  /// settle() found a change that nobody had confirmed.
  bool found_a_change() const { return found_a_change_; }
  /// networkd has not read yet what its files say: settle() does the rest.
  bool reload_is_due() const { return reload_.is_due(); }

  std::expected<void, std::string> apply(const network::Numbers& numbers) override;
  std::expected<void, std::string> keep(const network::Numbers& numbers) override;
  std::expected<void, std::string> revert() override;
  std::expected<std::optional<network::Numbers>, std::string> forget() override;
  /// Leads to these from now on, with whatever addresses are in use.
  std::expected<void, std::string> lead_to(const network::Endpoints& endpoints);

 private:
  /// One interface's two places, and what would stand there.
  struct Place {
    std::string interface, tried, kept, text;
    std::vector<std::uint32_t> addresses;
  };
  std::array<Place, 2> places(const network::Numbers& numbers) const;
  std::array<Place, 2> places() const;
  std::string confirmed_file() const { return options_.state + "/confirmed.json"; }
  std::string endpoints_file() const { return options_.state + '/' + network::kEndpointsFile; }
  std::expected<void, std::string> read();
  std::expected<bool, std::string> read_confirmed();
  void read_endpoints();
  void use_factory();
  /// What is to come of a file that changes; nothing where networkd has all of it already, or reads it as it
  /// starts.
  enum class Then : std::uint8_t { Reload, Nothing };
  std::expected<void, std::string> write(Then then);
  std::expected<void, std::string> set_aside(const std::string& why);
  std::expected<void, std::string> write_kept(const network::Numbers& numbers, Then then);
  std::expected<void, std::string> put(const std::string& file, const std::string& text, Then then);
  /// The text that networkd uses for an interface; "" if there is none.
  static std::expected<std::string, std::string> in_use_of(const Place& place);
  std::expected<void, std::string> check_unused(const Place& place) const;
  /// Whether any was there.
  std::expected<bool, std::string> remove_tried(Then then);

  const Options& options_;
  Prober probe_;
  Reload reload_;
  std::optional<network::Numbers> kept_, tried_;
  network::Endpoints endpoints_;
  bool found_a_change_ = false;
};

}  // namespace adit::applier
