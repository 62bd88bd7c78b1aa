#include "rehearsal/robots/map_offer.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace adit::robots {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr double kMegabyte = 1e6;
constexpr std::array<double, 3> kCloudEvery = {1, 0.5, 2};  // seconds, of one robot after the other

constexpr std::array<std::pair<std::string_view, GridForm>, 5> kGridForms = {
    {{"whole", GridForm::Whole},
     {"drifting", GridForm::Drifting},
     {"rolling", GridForm::Rolling},
     {"tiles", GridForm::Tiles},
     {"none", GridForm::None}}};
constexpr std::array<std::pair<std::string_view, CloudForm>, 3> kCloudForms = {
    {{"differential", CloudForm::Differential}, {"whole", CloudForm::Whole}, {"none", CloudForm::None}}};

template <class Form, std::size_t N>
std::optional<std::vector<Form>> read_forms(std::string_view text,
                                            const std::array<std::pair<std::string_view, Form>, N>& names) {
  std::vector<Form> forms;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const auto* const known =
        std::ranges::find(names, text.substr(at, end - at), &std::pair<std::string_view, Form>::first);
    if (known == names.end()) return std::nullopt;
    forms.push_back(known->second);
    at = end + 1;
  }
  return forms;
}

}  // namespace

MapOffer MapOffers::of(std::size_t robot) const {
  return {.grids = grids[robot % grids.size()],
          .clouds = clouds[robot % clouds.size()],
          .grid_every = Seconds(1 / grid_hz.value_or(1)),
          .cloud_every = Seconds(cloud_hz ? 1 / *cloud_hz : kCloudEvery[robot % kCloudEvery.size()]),
          .grid_bytes = static_cast<std::size_t>(grid_mb * kMegabyte),
          .cloud_bytes = static_cast<std::size_t>(cloud_mb * kMegabyte)};
}

bool MapOffers::has_grids() const {
  return std::ranges::any_of(grids, [](GridForm form) { return form != GridForm::None; });
}

bool MapOffers::has_clouds() const {
  return std::ranges::any_of(clouds, [](CloudForm form) { return form != CloudForm::None; });
}

std::optional<std::vector<GridForm>> read_grid_forms(std::string_view text) {
  return read_forms(text, kGridForms);
}

std::optional<std::vector<CloudForm>> read_cloud_forms(std::string_view text) {
  return read_forms(text, kCloudForms);
}

}  // namespace adit::robots
