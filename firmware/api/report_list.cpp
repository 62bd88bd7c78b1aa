#include "api/report_list.hpp"

#include <memory>
#include <utility>

#include "codec/row.hpp"

namespace adit::api {
namespace {

/// Half a millisecond of work.
constexpr std::size_t kInATurn = 64;

struct Listing : std::enable_shared_from_this<Listing> {
  loop::Loop& loop;
  const Source& source;
  const ListForm form;
  const std::optional<std::int64_t> run;
  const std::function<void(std::string)> done;
  std::string text = form.begin;
  std::int64_t last = 0;  // whose turn has been
  bool is_empty = true;

  Listing(loop::Loop& on, const Source& of, ListForm as, std::optional<std::int64_t> only,
          std::function<void(std::string)> then)
      : loop(on), source(of), form(std::move(as)), run(only), done(std::move(then)) {}

  void go_on() {
    const auto rows = source.reports(last, kInATurn);
    for (const ReportRow& row : rows) {
      last = row.number;
      if (run && row.run != *run) continue;
      if (!std::exchange(is_empty, false)) text += form.between;
      text += form.row(row);
    }
    if (rows.size() == kInATurn) return loop.post([self = shared_from_this()] { self->go_on(); });
    done(std::move(text.append(form.end)));
  }
};

}  // namespace

ListForm json_list() {
  return {.begin = "[",
          .row = [](const ReportRow& row) { return codec::to_json(row); },
          .between = ",",
          .end = "]"};
}

void list_reports(loop::Loop& loop, const Source& source, ListForm form, std::optional<std::int64_t> run,
                  std::function<void(std::string list)> done) {
  std::make_shared<Listing>(loop, source, std::move(form), run, std::move(done))->go_on();
}

}  // namespace adit::api
