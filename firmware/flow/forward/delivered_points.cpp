#include "forward/delivered_points.hpp"

#include <utility>
#include <variant>

#include "pack/pack.hpp"

namespace adit::forward {

/// Points that are not finite go first: no others may remain.
LeftOut LeavingOut::operator()(icd::MapUpdate& map) {
  if (!known_) return {};
  if (known_->epoch != epoch_) known_->voxels.forget();
  known_->epoch = epoch_;
  for (const Taken& each : std::exchange(taken_, {})) known_->voxels.add(each.robot, each.edge, each.voxels);
  const auto* const cloud = std::get_if<icd::PointCloud2>(&map.msg);
  if (edge_ == 0 || cloud == nullptr || map.data.compression != icd::Compression::None) return {};
  map.data = pack::without_invalid_points(*cloud, std::move(map.data));
  auto rest = known_->voxels.leave_out(*map.name, *cloud, map.data, edge_);
  map.data = std::move(rest.data);
  const bool is_all = rest.left_out > 0 && map.data.raw_size == 0;
  return {.points = rest.left_out,
          .is_all = is_all,
          .epoch = epoch_,
          .edge = edge_,
          .voxels = std::move(rest.voxels),
          .sent = {}};
}

void DeliveredPoints::edges_are(std::map<icd::RobotName, double> edges) {
  if (edges == edges_) return;
  edges_ = std::move(edges);
  forget();
}

void DeliveredPoints::forget() {
  ++epoch_;
  taken_.clear();
}

/// Without edges the worker clears its voxels.
LeavingOut DeliveredPoints::leaving_out(const icd::MapUpdate& map) {
  if (edges_.empty()) return {std::exchange(known_, nullptr), epoch_, 0, {}};
  if (!known_) known_ = std::make_shared<LeavingOut::Known>();
  const auto edge = map.name && !map.is_grid() ? edges_.find(*map.name) : edges_.end();
  return {known_, epoch_, edge == edges_.end() ? 0 : edge->second, std::exchange(taken_, {})};
}

void DeliveredPoints::taken(const icd::MapUpdate& map, LeftOut left_out) {
  if (left_out.edge == 0 || left_out.epoch != epoch_ || left_out.voxels.empty()) return;
  taken_.push_back({*map.name, left_out.edge, std::move(left_out.voxels)});
}

}  // namespace adit::forward
