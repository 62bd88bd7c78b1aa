#include "rehearsal/robots/messages.hpp"

#include <array>
#include <cmath>

namespace adit::robots {

Rotation rotation_of(double yaw) {
  return {.x = 0, .y = 0, .z = std::sin(yaw / 2), .w = std::cos(yaw / 2)};
}

std::uint32_t bytes_of(int datatype) {
  constexpr std::array<std::uint32_t, 9> kBytes = {0, 1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes.at(static_cast<std::size_t>(datatype));
}

Kind kind_of(const Message& message) {
  return static_cast<Kind>(message.index());  // the variant's order is the enumeration's
}
static_assert(
    std::is_same_v<std::variant_alternative_t<static_cast<std::size_t>(Kind::Grid), Message>, Grid>);
static_assert(
    std::is_same_v<std::variant_alternative_t<static_cast<std::size_t>(Kind::Status), Message>, StatusQuery>);

std::string_view name_of(Kind kind) {
  constexpr std::array<std::string_view, kKinds> kNames = {"grid",   "cloud",  "state",    "markers",
                                                           "report", "status", "preflight"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace adit::robots
