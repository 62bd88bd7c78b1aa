// A message's file in the spool.
#include "codec/read.hpp"
#include "codec/write.hpp"
#include "folder.hpp"
#include "spool/kept_message.hpp"

namespace adit::fuzz {
namespace {

/// What the file says, and says again where it is written again.
template <class Message, class Write>
void kept_as_read(const std::string& file, icd::Checked<Message> (*read)(const std::string&), Write write) {
  const auto message = read(file);
  if (!message) return require(!message.error().sentence.empty());
  write(*message, file + ".again");
  const auto again = read(file + ".again");
  require(again && *again == *message);
}

}  // namespace

void try_spool(Input text) {
  static const Folder folder;
  folder.put("kept", text);
  const std::string file = folder / "kept";
  kept_as_read(file, spool::read_state, [](const icd::StateUpdate& state, const std::string& again) {
    require(spool::replace_file(again, codec::write_state_update(state)).has_value());
  });
  kept_as_read(file, spool::read_markers, [](const icd::MarkersUpdate& markers, const std::string& again) {
    require(spool::replace_file(again, codec::write_markers_update(markers)).has_value());
  });
  kept_as_read(file, spool::read_map, [](icd::MapUpdate map, const std::string& again) {
    const icd::ChunkedBytes data = map.data.bytes;
    if (const auto checked = codec::check_data(map); !checked) require(!checked.error().sentence.empty());
    spool::MapFile kept(again);
    require(kept.finish(map, again) == 0 && map.data.bytes == data);
  });
}

}  // namespace adit::fuzz
