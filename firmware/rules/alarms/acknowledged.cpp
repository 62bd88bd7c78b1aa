#include "alarms/acknowledged.hpp"

#include "codec/field.hpp"
#include "codec/json.hpp"
#include "icd/try.hpp"

namespace adit::alarms {
namespace {

using codec::member;
using codec::Value;

constexpr std::int64_t kVersion = 1;

constexpr codec::Member kMembers[] = {
    member<&Acknowledged::id>("id"),         member<&Acknowledged::severity>("severity"),
    member<&Acknowledged::degree>("degree"), member<&Acknowledged::what>("what"),
    member<&Acknowledged::why>("why"),       member<&Acknowledged::at>("at", "seconds since 1970"),
};

}  // namespace

constexpr codec::Row Acknowledged::kRow = {"", kMembers};

std::string write_acknowledged(const std::vector<Acknowledged>& all) {
  return codec::write_json({Value::Object{{"version", {kVersion}}, {"acknowledged", codec::json(all)}}}) +
         '\n';
}

std::expected<std::vector<Acknowledged>, std::string> read_acknowledged(std::string_view json) {
  const auto root = ADIT_TRY(codec::parse_json(json));
  codec::Reading reading;
  const codec::Field file(root, reading);
  const codec::Field version = file.member("version");
  if (version.whole<std::int64_t>() != kVersion) version.refuse("expected ", kVersion);
  std::vector<Acknowledged> all;
  codec::KindOf<std::vector<Acknowledged>>::read(file.member("acknowledged"), all);
  const auto read = reading.outcome(true);
  if (!read) return std::unexpected(read.error().sentence);
  if (all.size() > Acknowledged::kMost) return std::unexpected("acknowledged: too many");
  return all;
}

}  // namespace adit::alarms
