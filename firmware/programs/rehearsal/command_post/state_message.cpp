#include "rehearsal/command_post/messages.hpp"

namespace adit::rehearsal {

std::optional<StateMessage> read_state(const Json& document, Findings& findings) {
  const Field body(document, "", findings);
  if (!body.is_object()) return std::nullopt;
  StateMessage message;
  if (!body.optional_member("header")) findings.displeases("Missing field 'header'");
  read_header(body, message.stamps);
  const auto poses = body.member("poses");
  const auto elements = poses ? poses->elements() : std::nullopt;
  if (!elements) return std::nullopt;
  for (const Field& pose : *elements) {
    const auto name = pose.member("name");
    const auto text = name ? name->text() : std::nullopt;
    const auto place = read_pose(pose);
    if (!text || !place) return std::nullopt;
    if (!is_robot_name(*text)) {
      name->breaks("expected 1 to 10 letters, digits and underscores (ICD 2)", Measured::Takes);
    }
    message.names.push_back(*text);
  }
  return message;
}

}  // namespace adit::rehearsal
