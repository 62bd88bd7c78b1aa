#include "ledger/mark.hpp"

#include <cctype>
#include <cstdio>

#include "ledger/proof.hpp"

namespace adit::ledger {
namespace {

constexpr const char* kWriteMark = R"(
  REPLACE INTO mark SELECT 1, ?1, ?2, highest, proof(1, ?1, ?2, highest)
  FROM (SELECT coalesce(max(number), 0) AS highest FROM report))";

constexpr const char* kReadMark = R"(
  SELECT log_needed, log_size, highest FROM mark
  WHERE proof = proof(number, log_needed, log_size, highest))";

/// For SQLite, which then reads the file as it is: no lock, no log.
std::string read_only_uri(const std::string& path) {
  std::string uri = "file:";
  for (const char letter : path) {
    if (std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '/') {
      uri += letter;
    } else {
      char escaped[4];
      const int length = std::snprintf(escaped, sizeof escaped, "%%%02X", static_cast<unsigned char>(letter));
      uri.append(escaped, static_cast<std::size_t>(length));
    }
  }
  return uri + "?immutable=1";
}

}  // namespace

Result<void> write_mark(Database& database, bool log_needed, std::int64_t log_size) {
  const auto statement = Statement::prepare(database, kWriteMark);
  if (!statement) return std::unexpected(statement.error());
  Query query(*statement);
  query.bind(std::int64_t{log_needed}).bind(log_size);
  if (query.step() != SQLITE_DONE) return std::unexpected(database.error("marking the ledger"));
  return {};
}

std::expected<std::optional<Mark>, MarkIsLost> mark_without_log(const std::string& path) {
  auto database = Database::open(read_only_uri(path), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI);
  if (!database || !teach_proof(*database)) return std::unexpected(MarkIsLost());
  const auto any = Statement::prepare(*database, "SELECT 1 FROM mark");
  const bool no_such_table = !any && sqlite3_errcode(database->get()) == SQLITE_ERROR;
  if (no_such_table || (any && Query(*any).step() == SQLITE_DONE)) return std::nullopt;
  const auto statement = Statement::prepare(*database, kReadMark);
  if (!statement) return std::unexpected(MarkIsLost());
  Query query(*statement);
  if (query.step() != SQLITE_ROW) return std::unexpected(MarkIsLost());
  return Mark{.log_needed = query.number(0) != 0, .log_size = query.number(1), .highest = query.number(2)};
}

}  // namespace adit::ledger
