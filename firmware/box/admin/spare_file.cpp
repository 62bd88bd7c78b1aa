#include "admin/spare_file.hpp"

#include <algorithm>
#include <compare>

#include "admin/kept_file.hpp"
#include "codec/row_file.hpp"

namespace adit::admin {
namespace {

constexpr codec::Member kRestMembers[] = {
    codec::member<&Rest::code>("code"),         codec::member<&Rest::since>("since"),
    codec::member<&Rest::stamp>("stamp"),       codec::member<&Rest::told>("told"),
    codec::member<&Rest::expected>("expected"),
};
constexpr codec::Member kTakenMembers[] = {
    codec::member<&TakenFrom::box>("box"),
    codec::member<&TakenFrom::at>("at"),
    codec::member<&TakenFrom::rest_count>("rest_count"),
};
constexpr codec::Member kFileMembers[] = {
    codec::member<&SpareFile::box>("box"),
    codec::member<&SpareFile::rest>("rest"),
    codec::member<&SpareFile::rest_count>("rest_count"),
    codec::member<&SpareFile::taken>("taken"),
};

}  // namespace

constexpr codec::Row Rest::kRow = {"", kRestMembers};
constexpr codec::Row TakenFrom::kRow = {"", kTakenMembers};
constexpr codec::Row SpareFile::kRow = {"", kFileMembers};

std::expected<SpareFile, std::string> SpareFile::read(const std::string& state_folder) {
  std::string unread;
  return read(state_folder, unread);
}

std::expected<SpareFile, std::string> SpareFile::read(const std::string& state_folder, std::string& unread) {
  return read_kept_file(state_folder + '/' + kName, &codec::read_file<SpareFile>, unread);
}

std::expected<void, std::string> SpareFile::write(const std::string& state_folder) const {
  return host::write_kept(state_folder + '/' + kName, codec::write_file(*this));
}

std::string SpareFile::hindrance(const spare::About& about) const {
  if (about.box == box) return "this box made the export itself: end the standby if no spare took over";
  const auto before = std::ranges::find(taken, about.box, &TakenFrom::box);
  if (before == taken.end()) return "";
  // Prefers the counts, because that box's clock may have been set back in between.
  const bool are_counted = about.rest_count && before->rest_count;
  const auto order = are_counted ? *about.rest_count <=> *before->rest_count : about.at <=> before->at;
  if (order > 0) return "";
  return order == 0 ? "this box already took over from this export"
                    : "this box already took over from a later export of the same box";
}

}  // namespace adit::admin
