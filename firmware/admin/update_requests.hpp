#pragma once

#include <expected>
#include <string>

#include "update/messages.hpp"

namespace adit::admin {

/// How aditd speaks with adit-update: by files (firmware/update/README.md).
class UpdateRequests {
 public:
  /// `state_folder`: where requests and bundles are left; `status_folder`: where they are answered.
  UpdateRequests(std::string state_folder, std::string status_folder)
      : state_(std::move(state_folder)), status_(std::move(status_folder)) {}

  /// How it stands, or why nobody says so.
  std::expected<update::Status, std::string> status() const;
  std::expected<void, std::string> ask(const update::Request& request);
  /// It is not to be done any more, where it has not been begun.
  void forget();

  /// Where a bundle is left, and where it is while it comes in.
  std::string bundle_file() const { return state_ + '/' + update::kBundleFile; }
  std::string part_file() const { return bundle_file() + ".part"; }
  const std::string& state_folder() const { return state_; }

 private:
  std::string state_, status_;
};

}  // namespace adit::admin
