#include "applier/stick.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "applier/bundle_file.hpp"
#include "host/log.hpp"
#include "update/version.hpp"

namespace adit::applier {
namespace {

/// Each is read once, which takes a while.
constexpr std::size_t kMost = 8;

std::vector<std::string> bundles_in(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& file : std::filesystem::directory_iterator(folder, none)) {
    const std::string name = file.path().filename().string();
    if (name.starts_with("adit-") && name.ends_with(".raucb")) names.push_back(name);
  }
  std::ranges::sort(names);
  if (names.size() > kMost) names.resize(kMost);
  return names;
}

/// What could be installed, or why not.
std::expected<update::Offer, std::string> judge(const std::string& folder, const std::string& name,
                                                const Rauc& rauc, const update::Running& running) {
  const auto file = BundleFile::open(folder + '/' + name);
  if (!file) return std::unexpected(file.error());
  const auto bundle = rauc.info(file->path());
  if (!bundle) return std::unexpected(bundle.error());
  if (std::string why = update::hindrance(*bundle, running, true); !why.empty())
    return std::unexpected(std::move(why));
  return update::Offer{name, bundle->version};
}

}  // namespace

OnStick look_at_stick(const std::string& folder, const Rauc& rauc, const update::Running& running) {
  OnStick found;
  for (const std::string& name : bundles_in(folder)) {
    const auto offer = judge(folder, name, rauc, running);
    const std::string shown = host::escaped(name);
    if (!offer) {
      found.trouble = shown + ": " + offer.error();
    } else if (!found.offer ||
               *update::Version::parse(found.offer->version) < *update::Version::parse(offer->version)) {
      found.offer = *offer;
    }
  }
  if (found.offer) found.trouble.clear();
  return found;
}

}  // namespace adit::applier
