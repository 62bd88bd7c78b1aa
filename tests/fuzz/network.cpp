// The files by which aditd and adit-network speak, and what adit-network keeps.
#include "network/messages.hpp"
#include "target.hpp"

namespace adit::fuzz {
namespace {

template <class Message>
void settles_as(Input text, network::Read<Message> (*read)(std::string_view)) {
  settles(text, read, [](const Message& message) { return network::write(message); });
}

}  // namespace

void try_network(Input text) {
  settles_as(text, network::read_wanted);
  settles_as(text, network::read_word);
  settles_as(text, network::read_probe);
  settles_as(text, network::read_endpoints);
  settles_as(text, network::read_forget);
  settles_as(text, network::read_status);
  settles_as(text, network::read_probed);
  settles(text, network::read_kept, network::write_kept);
}

}  // namespace adit::fuzz
