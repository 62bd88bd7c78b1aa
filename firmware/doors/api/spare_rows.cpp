#include "api/spare.hpp"

namespace adit::api {
namespace {

constexpr codec::Member kExportMembers[] = {
    codec::member<&ExportRow::name>("name", "address at which the team used the box that made the export"),
    codec::member<&ExportRow::version>("version", "version of that box"),
    codec::member<&ExportRow::at>("at", "start of that box's standby: seconds since 1970 by its clock"),
    codec::member<&ExportRow::reports>("reports", "number of reports"),
    codec::member<&ExportRow::open>("open", "number of reports that are still open"),
    codec::member<&ExportRow::post>("post", "address and port of the Command Post"),
    codec::member<&ExportRow::run>("run", "the run's last status; null if there was none"),
    codec::member<&ExportRow::port>(
        "port", "first port of that box for the team; this box listens there after the take-over"),
    codec::member<&ExportRow::left_out>("left_out", "settings of that box that are unknown here"),
};

constexpr codec::Member kStickExportMembers[] = {
    codec::member<&StickExportRow::name>("name", "name of the file"),
    codec::member<&StickExportRow::box>(
        "box",
        "address of the box that made the export, from the file's name; empty if the name has no address"),
    codec::member<&StickExportRow::at>(
        "at", "start of that box's standby, from the file's name; null if the name has no time"),
};

constexpr codec::Member kStickMembers[] = {
    codec::member<&StickRow::hindrance>("hindrance", "why no export can be written to the stick, or empty"),
    codec::member<&StickRow::unreadable>(
        "unreadable", "why the stick cannot be read; empty if it can, or if exports were found"),
    codec::member<&StickRow::doing>("doing", "writing, checking or reading, or empty"),
    codec::member<&StickRow::refusal>("refusal", "why the last action failed, or empty"),
    codec::member<&StickRow::written>(
        "written", "name of this box's export on the stick after it was checked, or empty"),
    codec::member<&StickRow::exports>("exports", "exports on the stick, latest first"),
};

constexpr codec::Member kSpareMembers[] = {
    codec::member<&SpareView::standby>("standby",
                                       "whether the box is on standby: it accepts and sends no messages"),
    codec::member<&SpareView::why>("why", "why the box is on standby, or empty"),
    codec::member<&SpareView::since>(
        "since", "start of standby in seconds since 1970; null if the box is not on standby"),
    codec::member<&SpareView::code>(
        "code", "code that opens the box's export, in groups of digits; empty if there is no export"),
    codec::member<&SpareView::asks_code>("asks_code", "whether an imported export needs its code"),
    codec::member<&SpareView::taken_in>("taken_in",
                                        "content of the opened export; null if no export is open"),
    codec::member<&SpareView::takes_over>("takes_over", "whether a take-over is in progress"),
    codec::member<&SpareView::stick>("stick", "the stick in the box; null if sticks are not available here"),
};

}  // namespace

constexpr codec::Row ExportRow::kRow = {"SpareExport", kExportMembers};
constexpr codec::Row StickExportRow::kRow = {"SpareStickExport", kStickExportMembers};
constexpr codec::Row StickRow::kRow = {"SpareStick", kStickMembers};
constexpr codec::Row SpareView::kRow = {"Spare", kSpareMembers};

}  // namespace adit::api
