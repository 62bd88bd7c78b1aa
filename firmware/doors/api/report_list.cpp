#include "api/report_list.hpp"

#include <memory>
#include <utility>

#include "codec/row.hpp"

namespace adit::api {
namespace {

/// Reports for half a millisecond of work.
constexpr std::size_t kInATurn = 64;

}  // namespace

struct ReportLists::Listing {
  const ListForm form;
  const std::optional<std::int64_t> run;
  const std::function<void(std::string)> done;
  std::string text = form.begin;
  std::int64_t last = 0;  // the last written report
  bool is_empty = true;
};

ListForm json_list() {
  return {.begin = "[",
          .row = [](const ReportRow& row) { return codec::to_json(row); },
          .between = ",",
          .end = "]"};
}

void ReportLists::write(ListForm form, std::optional<std::int64_t> run,
                        std::function<void(std::string list)> done) const {
  go_on(std::make_shared<Listing>(std::move(form), run, std::move(done)));
}

void ReportLists::go_on(const std::shared_ptr<Listing>& listing) const {
  const auto rows = source_.reports(listing->last, kInATurn);
  for (const ReportRow& row : rows) {
    listing->last = row.number;
    if (listing->run && row.run != *listing->run) continue;
    if (!std::exchange(listing->is_empty, false)) listing->text += listing->form.between;
    listing->text += listing->form.row(row);
  }
  if (rows.size() == kInATurn) {
    return loop_.post([this, listing] { go_on(listing); });
  }
  listing->done(std::move(listing->text.append(listing->form.end)));
}

}  // namespace adit::api
