#include "admin/spare_file.hpp"

#include <algorithm>

#include "admin/kept_file.hpp"
#include "codec/row_file.hpp"

namespace adit::admin {
namespace {

constexpr codec::FileFormat kFormat = {"format", 1};

constexpr codec::Member kRestMembers[] = {
    codec::member<&Rest::code>("code"),
    codec::member<&Rest::since>("since"),
    codec::member<&Rest::expected>("expected"),
};
constexpr codec::Member kTakenMembers[] = {
    codec::member<&TakenFrom::box>("box"),
    codec::member<&TakenFrom::at>("at"),
};
constexpr codec::Member kFileMembers[] = {
    codec::member<&SpareFile::box>("box"),
    codec::member<&SpareFile::rest>("rest"),
    codec::member<&SpareFile::taken>("taken"),
};

}  // namespace

constexpr codec::Row Rest::kRow = {"", kRestMembers};
constexpr codec::Row TakenFrom::kRow = {"", kTakenMembers};
constexpr codec::Row SpareFile::kRow = {"", kFileMembers};

std::expected<SpareFile, std::string> SpareFile::read(const std::string& state_folder) {
  return read_kept_file(state_folder + '/' + kName,
                        [](std::string_view text) { return codec::read_file<SpareFile>(text, kFormat); });
}

std::expected<void, std::string> SpareFile::write(const std::string& state_folder) const {
  return host::write_file(state_folder + '/' + kName, codec::write_file(*this, kFormat), host::kOursAlone);
}

std::string SpareFile::hindrance(const std::string& its_box, double at) const {
  if (its_box == box) return "this box made the export itself: wake it up, if no spare took over";
  const auto before = std::ranges::find(taken, its_box, &TakenFrom::box);
  if (before == taken.end() || at > before->at) return "";
  return at == before->at ? "this box took over from this export already"
                          : "this box took over from a later export of that box already";
}

}  // namespace adit::admin
