#pragma once

#include <array>
#include <chrono>
#include <expected>
#include <string>
#include <vector>

#include "applier/arp.hpp"
#include "applier/options.hpp"
#include "network/change.hpp"

namespace adit::applier {

/// The duty to make networkd read its files again, from before a file changes until networkd has read them. A
/// file in memory preserves it across a kill, and is lost at boot like networkd's own files.
class Reload {
 public:
  static constexpr std::chrono::seconds kWithin{30};

  /// `options` must outlive this object.
  explicit Reload(const Options& options) : options_(options) {}

  bool is_due() const;
  /// Call before a file changes. If the mark cannot be written, only a kill would lose it.
  void set_due();
  /// Reloads if due. After an error it is still due.
  std::expected<void, std::string> run();

 private:
  std::string file() const { return options_.status + "/reload-due"; }

  const Options& options_;
  bool is_due_ = false;  // as known to this process
};

/// The numbers as systemd-networkd's files. Unchanged interfaces are left alone. Used addresses are rejected.
class NetworkdFiles final : public network::NumbersSetter {
 public:
  using Prober = decltype(&probe);

  /// `options` must outlive this object.
  explicit NetworkdFiles(const Options& options, Prober prober = &probe)
      : options_(options), probe_(prober), reload_(options) {}

  /// Restores the confirmed numbers, or the factory ones, in networkd's directory, removes files on trial,
  /// and makes networkd reload. Safe after a kill at any point. Error: that failed.
  std::expected<void, std::string> settle();
  /// The same before networkd starts. If the confirmed numbers cannot be read, uses the factory ones, because
  /// a box without addresses cannot be reached.
  std::expected<void, std::string> write_at_start();
  /// The confirmed numbers, or the factory ones.
  const std::optional<network::Numbers>& confirmed_numbers() const { return kept_; }
  const network::Endpoints& endpoints() const { return endpoints_; }
  /// Whether settle() found an unconfirmed change.
  bool has_unconfirmed_change() const { return has_unconfirmed_change_; }
  /// Whether networkd has still to read its files; settle() retries.
  bool reload_is_due() const { return reload_.is_due(); }

  std::expected<void, std::string> apply(const network::Numbers& numbers) override;
  std::expected<void, std::string> keep(const network::Numbers& numbers) override;
  std::expected<void, std::string> revert() override;
  std::expected<std::optional<network::Numbers>, std::string> forget() override;
  /// Sets routes to these endpoints with the present addresses.
  std::expected<void, std::string> lead_to(const network::Endpoints& endpoints);

 private:
  /// One interface's two files, and their wanted text.
  struct Place {
    std::string interface, tried, kept;
    std::string text = "";
    std::vector<std::uint32_t> addresses = {};
  };
  std::array<Place, 2> places(const network::Numbers& numbers) const;
  std::array<Place, 2> places() const;
  std::string confirmed_file() const { return options_.state + "/confirmed.json"; }
  std::string endpoints_file() const { return options_.state + '/' + network::kEndpointsFile; }
  std::expected<void, std::string> read();
  std::expected<bool, std::string> read_confirmed();
  void read_endpoints();
  void use_factory();
  /// Action after a file changes. Nothing: networkd has the content already, or reads it when it starts.
  enum class FollowUp : std::uint8_t { Reload, Nothing };
  std::expected<void, std::string> write(FollowUp then);
  std::expected<void, std::string> set_aside(const std::string& why);
  std::expected<void, std::string> write_kept(const network::Numbers& numbers, FollowUp then);
  std::expected<void, std::string> put(const std::string& file, const std::string& text, FollowUp then);
  /// The text that networkd uses for an interface; "" if there is none.
  static std::expected<std::string, std::string> current_text(const Place& place);
  std::expected<void, std::string> check_unused(const Place& place) const;
  /// Returns whether a file was removed.
  std::expected<bool, std::string> remove_tried(FollowUp then);

  const Options& options_;
  Prober probe_;
  Reload reload_;
  std::optional<network::Numbers> kept_, tried_;
  network::Endpoints endpoints_;
  bool has_unconfirmed_change_ = false;
};

}  // namespace adit::applier
