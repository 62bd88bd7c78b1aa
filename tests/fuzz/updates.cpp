// The files by which aditd and adit-update speak, and what adit-update keeps.
#include "target.hpp"
#include "update/messages.hpp"

namespace adit::fuzz {
namespace {

template <class Message>
void reads_as_written(Input text, update::Read<Message> (*read)(std::string_view)) {
  settles(text, read, [](const Message& message) { return update::write(message); });
}

}  // namespace

void try_updates(Input text) {
  reads_as_written(text, update::read_request);
  reads_as_written(text, update::read_status_file);
  reads_as_written(text, update::read_last_update);
}

}  // namespace adit::fuzz
