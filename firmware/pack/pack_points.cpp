#include "pack/pack_points.hpp"

#include <optional>
#include <utility>

#include "codec/gzip_whole.hpp"
#include "pack/arrange.hpp"
#include "pack/point_layout.hpp"
#include "pack/rounding.hpp"

namespace adit::pack {

void pack_points(icd::PointCloud2& cloud, icd::MapData& data, const CloudForm& form) {
  if (data.bytes.empty() || form.effort == Effort::None) return;
  const bool is_full = form.effort == Effort::Full;
  const auto tight = form.is_arranged ? without_padding(cloud) : std::nullopt;
  const PointLayout layout = tight ? *tight : unchanged(cloud);
  Arranged arranged = in_one_piece(layout, data, cloud.point_step);
  if (tight && is_full && form.unit > 0) round_to(form.unit, arranged);
  if (tight && is_full) put_in_order(arranged);
  const int level = is_full ? kPointsLevel : codec::kFastestLevel;
  auto member = codec::gzip_whole(arranged.points, level, arranged.points.size() - 1);
  if (!member && layout.cloud == cloud) return;
  if (!member) arranged = in_one_piece(layout, data, cloud.point_step);  // exact and in their order
  cloud = std::move(arranged.cloud);
  data.raw_size = arranged.points.size();
  data.compression = member ? icd::Compression::Gzip : icd::Compression::None;
  data.bytes = member ? *std::move(member) : icd::ChunkedBytes{arranged.points};
}

}  // namespace adit::pack
