#include "targets.hpp"

#include <algorithm>

namespace adit::fuzz {

void try_accounts(Input);
void try_answer(Input);
void try_api(Input);
void try_base64(Input);
void try_card(Input);
void try_cbor(Input);
void try_chunks(Input);
void try_clock(Input);
void try_coding(Input);
void try_gzip(Input);
void try_heads(Input);
void try_journal(Input);
void try_json(Input);
void try_ledger(Input);
void try_names(Input);
void try_network(Input);
void try_panel(Input);
void try_rauc(Input);
void try_same_cbor(Input);
void try_same_json(Input);
void try_settings(Input);
void try_spool(Input);
void try_store(Input);
void try_updates(Input);

namespace {

constexpr Target kTargets[] = {
    {"accounts", try_accounts},   {"answer", try_answer},     {"base64", try_base64},
    {"card", try_card, 300},      {"cbor", try_cbor},         {"chunks", try_chunks},
    {"clock", try_clock},         {"coding", try_coding},     {"gzip", try_gzip},
    {"heads", try_heads},         {"journal", try_journal},   {"json", try_json},
    {"ledger", try_ledger, 50},   {"names", try_names},       {"network", try_network},
    {"panel", try_panel},         {"rauc", try_rauc},         {"same_cbor", try_same_cbor},
    {"same_json", try_same_json}, {"settings", try_settings}, {"spool", try_spool, 500},
    {"store", try_store, 300},    {"updates", try_updates},
#ifdef ADIT_FUZZ_API
    {"api", try_api, 1500},
#endif
};

}  // namespace

std::span<const Target> targets() {
  return kTargets;
}

const Target* target_named(std::string_view name) {
  const auto* found = std::ranges::find(kTargets, name, &Target::name);
  return found == std::end(kTargets) ? nullptr : found;
}

}  // namespace adit::fuzz
