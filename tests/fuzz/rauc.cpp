// What RAUC prints of a bundle's manifest and of the slots, and what files on a stick are called.
#include "target.hpp"
#include "update/bundle.hpp"

namespace adit::fuzz {

void try_rauc(Input text) {
  const auto status = update::read_status(text);
  require(status || !status.error().empty());
  if (const auto bundle = update::read_info(text)) {
    const update::RunningSystem running{.compatible = "adit-qemu-virt", .version = "0.1.0"};
    const bool may_be_installed = update::refusal_reason(*bundle, running, true).empty();
    require(!may_be_installed || bundle->compatible == running.compatible);
  } else {
    require(!bundle.error().empty());
  }

  const auto percent = update::percent_in(text);
  require(!percent || (*percent >= 0 && *percent <= 100));
  const auto half = text.size() / 2;
  (void)update::fault_in(text.substr(0, half), text.substr(half));
  if (const auto version = update::Version::parse(text)) require(*version == *version);
  const auto promise = update::promise_of(text, "adit-qemu-virt");
  require(!promise.for_this_board || text.starts_with("adit-qemu-virt"));
}

}  // namespace adit::fuzz
