// The files by which aditd and adit-network speak, and what adit-network keeps.
#include "network/messages.hpp"
#include "target.hpp"

namespace adit::fuzz {

void try_network(Input text) {
  settles(text, network::read<network::Wanted>);
  settles(text, network::read<network::Word>);
  settles(text, network::read<network::Probe>);
  settles(text, network::read<network::Endpoints>);
  settles(text, network::read<network::Forget>);
  settles(text, network::read<network::Status>);
  settles(text, network::read<network::Probed>);
  settles(text, network::read<network::Taken>);
  settles(text, network::read_kept, network::write_kept);
}

}  // namespace adit::fuzz
