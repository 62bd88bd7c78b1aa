// The files by which aditd and adit-network speak, and what adit-network keeps.
#include "network/messages.hpp"
#include "target.hpp"

namespace adit::fuzz {

void try_network(Input text) {
  settles(text, codec::read_file<network::ChangeRequest>);
  settles(text, codec::read_file<network::Decision>);
  settles(text, codec::read_file<network::Probe>);
  settles(text, codec::read_file<network::Endpoints>);
  settles(text, codec::read_file<network::TeamPorts>);
  settles(text, codec::read_file<network::FactoryRequest>);
  settles(text, codec::read_file<network::Status>);
  settles(text, codec::read_file<network::ProbeResult>);
  settles(text, codec::read_file<network::AddressConflicts>);
  settles(text, network::read_kept, network::write_kept);
}

}  // namespace adit::fuzz
