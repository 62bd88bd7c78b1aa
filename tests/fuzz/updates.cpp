// The files by which aditd and adit-update speak, and what adit-update keeps.
#include "target.hpp"
#include "update/messages.hpp"

namespace adit::fuzz {

void try_updates(Input text) {
  settles(text, update::read<update::Request>);
  settles(text, update::read<update::Status>);
  settles(text, update::read<update::LastUpdate>);
}

}  // namespace adit::fuzz
