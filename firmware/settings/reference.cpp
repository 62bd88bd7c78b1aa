#include "settings/reference.hpp"

#include "settings/keys.hpp"

namespace adit::settings {

std::string reference() {
  const Settings defaults = with_an_item_of_each();
  std::string table = "| key | meaning | default | allowed |\n| --- | --- | --- | --- |\n";
  for (const Key& key : keys()) {
    table.append("| `").append(key.path).append("` | ").append(key.meaning).append(" | ");
    if (key.required) {
      table.append("required");
    } else {
      table.append("`").append(written(key.kind, defaults)).append("`");
    }
    table.append(" | ").append(range_of(key.kind)).append(" |\n");
  }
  return table;
}

}  // namespace adit::settings
