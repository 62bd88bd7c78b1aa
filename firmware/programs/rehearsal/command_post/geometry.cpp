#include "rehearsal/command_post/geometry.hpp"

#include <cmath>
#include <string>

namespace adit::rehearsal {
namespace {

std::optional<Quaternion> read_quaternion(const Field& quaternion) {
  const auto x = quaternion.number("x"), y = quaternion.number("y"), z = quaternion.number("z"),
             w = quaternion.number("w");
  if (!x || !y || !z || !w) return std::nullopt;
  constexpr double kNoise = 2e-6;  // of float32, and of printed digits
  const double length = std::hypot(std::hypot(*x, *y, *z), *w);
  if (!(std::abs(length - 1) <= kNoise)) {
    quaternion.breaks("expected a quaternion of length 1, got one of length " + std::to_string(length),
                      Measured::Takes);
  }
  return Quaternion{*x, *y, *z, *w};
}

}  // namespace

std::optional<Point> read_point(const Field& point) {
  const auto x = point.number("x"), y = point.number("y"), z = point.number("z");
  if (!x || !y || !z) return std::nullopt;
  return Point{*x, *y, *z};
}

std::optional<Pose> read_pose(const Field& pose) {
  const auto position = pose.member("position");
  const auto orientation = pose.member("orientation");
  if (!position || !orientation) return std::nullopt;
  const auto point = read_point(*position);
  const auto quaternion = read_quaternion(*orientation);
  if (!point || !quaternion) return std::nullopt;
  return Pose{*point, *quaternion};
}

void read_header(const Field& message, std::vector<Stamp>& stamps) {
  const auto header = message.optional_member("header");
  if (!header || !header->is_object()) return;
  if (const auto frame_id = header->optional_member("frame_id")) {
    const auto text = frame_id->text();
    // The measured server writes "darpa" over any other, saying nothing.
    if (text && *text != "darpa") frame_id->breaks("expected \"darpa\" (ICD 6.1)", Measured::Takes);
  }
  if (const auto stamp = header->optional_member("stamp")) {
    const auto seconds = stamp->number();
    if (!seconds) return;
    if (*seconds < 0) {
      stamp->breaks("expected seconds from 0");
    } else {
      stamps.push_back({*seconds, stamp->path()});
    }
  }
}

}  // namespace adit::rehearsal
