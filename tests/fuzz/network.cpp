// The files by which aditd and adit-network speak, and what adit-network keeps.
#include "network/messages.hpp"
#include "target.hpp"

namespace adit::fuzz {

void try_network(Input text) {
  settles(text, network::read_wanted);
  settles(text, network::read_word);
  settles(text, network::read_probe);
  settles(text, network::read_endpoints);
  settles(text, network::read_forget);
  settles(text, network::read_status);
  settles(text, network::read_probed);
  settles(text, network::read_kept, network::write_kept);
}

}  // namespace adit::fuzz
