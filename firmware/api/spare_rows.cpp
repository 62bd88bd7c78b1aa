#include "api/spare.hpp"

namespace adit::api {
namespace {

constexpr codec::Member kExportMembers[] = {
    codec::member<&ExportRow::name>("name", "where the team found the box that made it"),
    codec::member<&ExportRow::version>("version", "of that box's Adit"),
    codec::member<&ExportRow::at>("at", "when that box came to rest; seconds since 1970, by its clock"),
    codec::member<&ExportRow::reports>("reports", "all that it knows"),
    codec::member<&ExportRow::open>("open", "of these, those with which something is still to happen"),
    codec::member<&ExportRow::post>("post", "the Command Post: address and port"),
    codec::member<&ExportRow::run>("run", "as it last heard; null: never"),
    codec::member<&ExportRow::left_out>("left_out", "of its settings, those that are not known here"),
};

constexpr codec::Member kStickExportMembers[] = {
    codec::member<&StickExportRow::name>("name", "of the file"),
    codec::member<&StickExportRow::box>(
        "box", "where the team found the box that made it, as the name says; empty: it does not"),
    codec::member<&StickExportRow::at>("at",
                                       "when that box came to rest, as the name says; null: it does not"),
};

constexpr codec::Member kStickMembers[] = {
    codec::member<&StickRow::hindrance>("hindrance", "why no export can be written to it; empty: it can"),
    codec::member<&StickRow::doing>("doing", "writing, checking or reading; empty: nothing"),
    codec::member<&StickRow::refusal>("refusal", "why what was asked of it last came to nothing; or empty"),
    codec::member<&StickRow::written>("written",
                                      "the file on it that is this box's export, read back; or empty"),
    codec::member<&StickRow::exports>("exports", "that are on it, the latest first"),
};

constexpr codec::Member kSpareMembers[] = {
    codec::member<&SpareView::rests>("rests", "it takes nothing and sends nothing"),
    codec::member<&SpareView::why>("why", "it rests; empty where it does not"),
    codec::member<&SpareView::since>("since", "it rests; seconds since 1970. null: it does not"),
    codec::member<&SpareView::code>("code", "that opens its export, in groups; empty: there is none"),
    codec::member<&SpareView::asks_code>("asks_code", "an export was taken in, and waits for its code"),
    codec::member<&SpareView::taken_in>("taken_in", "and opened; null: nothing is"),
    codec::member<&SpareView::takes_over>("takes_over", "that is under way"),
    codec::member<&SpareView::stick>("stick", "in the box; null: here no stick is written or read"),
};

}  // namespace

constexpr codec::Row ExportRow::kRow = {"SpareExport", kExportMembers};
constexpr codec::Row StickExportRow::kRow = {"SpareStickExport", kStickExportMembers};
constexpr codec::Row StickRow::kRow = {"SpareStick", kStickMembers};
constexpr codec::Row SpareView::kRow = {"Spare", kSpareMembers};

}  // namespace adit::api
