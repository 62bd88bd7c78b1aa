// The files by which aditd and adit-update speak, and what adit-update keeps.
#include "target.hpp"
#include "update/messages.hpp"

namespace adit::fuzz {

void try_updates(Input text) {
  settles(text, codec::read_file<update::Request>);
  settles(text, codec::read_file<update::Status>);
  settles(text, codec::read_file<update::LastUpdate>);
}

}  // namespace adit::fuzz
