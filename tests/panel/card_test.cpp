// The lights on the printable card (board/card.html) match the table of states.
#include <gtest/gtest.h>

#include "panel/states.hpp"
#include "project_files.hpp"

namespace adit::panel {
namespace {

/// "`adit status`" as HTML.
std::string html(std::string_view text) {
  std::string converted;
  bool code = false;
  for (const char each : text) {
    if (each != '`') {
      converted += each;
      continue;
    }
    code = !code;
    converted += code ? "<code>" : "</code>";
  }
  return converted;
}

std::string states() {
  std::string table;
  for (const StateRow& row : state_table()) {
    table += "<tr>";
    for (const auto& pattern : row.patterns) {
      const std::string name(pattern ? name_of(*pattern) : "");
      table.append("<td class=\"")
          .append(name.empty() ? "any" : name)
          .append("\">")
          .append(name)
          .append("</td>");
    }
    table.append("<td>").append(html(row.meaning)).append("</td></tr>\n");
  }
  return table;
}

/// The light over two seconds, one pixel per 20 ms.
std::string strip(Pattern pattern) {
  std::string svg = "<svg viewBox=\"0 0 100 8\" preserveAspectRatio=\"none\"><path d=\"";
  const Milliseconds end = std::chrono::seconds(2);
  for (Milliseconds at{}; at < end;) {
    const Moment now = repeated_moment(steps_of(pattern), at);
    const Milliseconds next = std::min(end, at + now.lasts.value_or(end));
    if (now.lit) {
      svg.append("M").append(std::to_string(at.count() / 20)).append(" 0h");
      svg.append(std::to_string((next - at).count() / 20)).append("v8h-");
      svg.append(std::to_string((next - at).count() / 20)).append("z");
    }
    at = next;
  }
  return svg + "\"/></svg>";
}

/// The visible pattern, in the README's words.
std::string seen(Pattern pattern) {
  const std::string text = project_text("firmware/doors/panel/README.md"),
                    head = "\n| " + std::string(name_of(pattern)) + " | ";
  const std::size_t at = text.find(head) + head.size();
  return text.substr(at, text.find(" |", at) - at);
}

std::string patterns() {
  std::string table;
  for (const Pattern pattern : kPatterns) {
    if (pattern == Pattern::Off || pattern == Pattern::On) continue;
    const std::string drawn = pattern == Pattern::Digits ? "" : strip(pattern);
    const std::string words = pattern == Pattern::Digits
                                  ? "flashes to be counted, ten for 0, a long one for each dot"
                                  : seen(pattern);
    table.append("<tr><th>").append(name_of(pattern)).append("</th><td>").append(drawn).append("</td><td>");
    table.append(words).append("</td></tr>\n");
  }
  return table;
}

TEST(PanelCard, HasTheTableOfTheStates) {
  EXPECT_NE(project_text("board/card.html").find("<tbody class=\"states\">\n" + states() + "</tbody>"),
            std::string::npos)
      << "put this into board/card.html:\n<tbody class=\"states\">\n"
      << states() << "</tbody>";
}

TEST(PanelCard, DrawsThePatterns) {
  EXPECT_NE(project_text("board/card.html").find("<tbody class=\"patterns\">\n" + patterns() + "</tbody>"),
            std::string::npos)
      << "put this into board/card.html:\n<tbody class=\"patterns\">\n"
      << patterns() << "</tbody>";
}

}  // namespace
}  // namespace adit::panel
