#include "applier/stick.hpp"

#include <algorithm>
#include <vector>

#include "applier/bundle_file.hpp"
#include "applier/sticks.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/try.hpp"
#include "update/bundle_name.hpp"

namespace adit::applier {
namespace {

/// Each candidate is read once, which is slow.
constexpr std::size_t kMost = 8;

struct Candidate {
  std::string folder, name;
  update::Promise promise;
};

/// The most promising files of all sticks.
std::vector<Candidate> candidates(const std::string& sticks, const std::string& compatible,
                                  std::string& trouble) {
  std::vector<Candidate> found;
  const auto all = host::names_in(sticks);
  if (!all) trouble = "the sticks: " + all.error();
  for (const std::string& stick : all.value_or(std::vector<std::string>())) {
    const std::string folder = sticks + '/' + stick;
    const auto names = host::names_in(folder, Sticks::kMostAtTop);
    if (!names) trouble = host::escaped(stick) + ": " + names.error();
    for (const std::string& name : names.value_or(std::vector<std::string>())) {
      if (update::is_bundle_name(name)) found.push_back({folder, name, update::promise_of(name, compatible)});
    }
  }
  std::ranges::sort(found, [](const Candidate& left, const Candidate& right) {
    return left.promise == right.promise ? left.name < right.name : left.promise > right.promise;
  });
  if (found.size() > kMost) found.resize(kMost);
  return found;
}

/// The update in a file, or why it cannot be installed.
std::expected<update::Offer, std::string> judge(const Candidate& candidate, const Rauc& rauc,
                                                const update::Running& running) {
  if (!update::is_plain(candidate.name))
    return std::unexpected("rename the file: only ASCII characters are allowed");
  const auto file = ADIT_TRY(BundleFile::open(candidate.folder + '/' + candidate.name));
  const auto bundle = ADIT_TRY(rauc.info(file.path()));
  if (std::string why = update::hindrance(bundle, running, true); !why.empty())
    return std::unexpected(std::move(why));
  return update::Offer{candidate.name, bundle.version};
}

}  // namespace

OnStick look_at_sticks(const std::string& folder, const Rauc& rauc, const update::Running& running) {
  OnStick found;
  for (const Candidate& candidate : candidates(folder, running.compatible, found.trouble)) {
    const auto offer = judge(candidate, rauc, running);
    if (!offer) {
      found.trouble = host::escaped(candidate.name) + ": " + offer.error();
    } else if (!found.offer ||
               *update::Version::parse(found.offer->version) < *update::Version::parse(offer->version)) {
      found.offer = *offer;
      found.path = candidate.folder + '/' + candidate.name;
    }
  }
  if (found.offer) found.trouble.clear();
  return found;
}

}  // namespace adit::applier
