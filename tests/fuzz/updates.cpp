// The files by which aditd and adit-update speak, and what adit-update keeps.
#include "target.hpp"
#include "update/messages.hpp"

namespace adit::fuzz {

void try_updates(Input text) {
  settles(text, update::read_request);
  settles(text, update::read_status_file);
  settles(text, update::read_last_update);
}

}  // namespace adit::fuzz
