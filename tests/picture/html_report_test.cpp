#include "core/picture/html_report.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/picture/markup.h"
#include "core/picture/plot.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace picture;

namespace {

std::size_t occurrences(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size()))
    ++count;
  return count;
}

TEST(HtmlReport, AllTextIsEscaped) {
  const std::string evil = "<script>alert('x')</script> & \"quoted\"";
  HtmlReport report(evil, evil);
  report.heading(evil);
  report.heading(evil, 3);
  report.heading(evil);
  report.paragraph(evil);
  report.key_figures({{evil, evil, evil}});
  report.table({evil, {evil, "b"}, {{evil, evil}}});
  report.picture("bytes", PictureFormat::kPng, evil);
  const std::string html = report.html();
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("alert('"), std::string::npos);
  // The text occurs twice as title, once as subtitle, in three headings and two links to them, in a
  // paragraph, three parts of the figure, a caption, a head and two cells of the table, and twice with the
  // picture.
  EXPECT_EQ(occurrences(html, escape_markup(evil)), 2u + 1 + 3 + 2 + 1 + 3 + 1 + 1 + 2 + 2);
}

TEST(HtmlReport, TagsAreBalanced) {
  HtmlReport report("Title");
  report.heading("A");
  report.heading("B");
  report.key_figures({{"Tetrahedra", "11990", ""}, {"Error", "0.149", "cm"}});
  report.table({"Meshes", {"name", "count"}, {{"a", "1"}, {"b", "2"}}});
  const std::string html = report.html();
  for (const std::string tag :
       {"html", "head", "body", "main",  "header",  "style", "h1",    "h2", "nav", "ul", "li", "dl",   "dt",
        "dd",   "div",  "span", "table", "caption", "thead", "tbody", "tr", "th",  "td", "a",  "title"}) {
    EXPECT_EQ(occurrences(html, "<" + tag + ">") + occurrences(html, "<" + tag + " "),
              occurrences(html, "</" + tag + ">"))
        << tag;
  }
}

TEST(HtmlReport, NeedsNothingFromOutside) {
  HtmlReport report("Title");
  Plot plot;
  plot.series = {{.name = "s", .x = {1, 2}, .y = {3, 4}}};
  report.picture(draw_plot(plot, PictureFormat::kPng), PictureFormat::kPng, "as PNG");
  report.picture(draw_plot(plot, PictureFormat::kSvg), PictureFormat::kSvg, "as SVG");
  const std::string html = report.html();
  for (const char* reference : {"http:", "https:", "<link", "@import", "url(", "src=\"/"})
    EXPECT_EQ(html.find(reference), std::string::npos) << reference;
  EXPECT_EQ(occurrences(html, "src="), occurrences(html, "src=\"data:image/"));
  EXPECT_NE(html.find("data:image/svg+xml;base64," + base64(draw_plot(plot, PictureFormat::kSvg))),
            std::string::npos);
  EXPECT_NE(html.find("Figure 2. as SVG"), std::string::npos);
}

TEST(HtmlReport, ColumnsOfNumbersAreSetToTheRight) {
  HtmlReport report("Title");
  report.table(
      {"", {"name", "count", "mixed", "gaps"}, {{"a", "1 234", "1", "-"}, {"b", "-2.5e-3", "x", "7%"}}});
  const std::string html = report.html();
  EXPECT_NE(
      html.find("<th>name</th><th class=\"number\">count</th><th>mixed</th><th class=\"number\">gaps</th>"),
      std::string::npos);
  EXPECT_NE(html.find("<td>b</td><td class=\"number\">-2.5e-3</td><td>x</td><td class=\"number\">7%</td>"),
            std::string::npos);
}

TEST(HtmlReport, BadInputIsAnErrorAndLeavesNothing) {
  const test::Scratch folder;
  HtmlReport report("Title");
  EXPECT_THROW(report.heading("x", 1), Error);
  EXPECT_THROW(report.table({"", {"a", "b"}, {{"1"}}}), Error);
  EXPECT_THROW(report.picture("x", PictureFormat::kPdf, ""), Error);
  EXPECT_THROW(report.write(folder / "none" / "report.html"), Error);
  EXPECT_EQ(folder.entries(), 0);
  report.write(folder / "report.html");
  EXPECT_EQ(test::bytes_of(folder / "report.html"), report.html());
  EXPECT_EQ(folder.entries(), 1);
}

}  // namespace
}  // namespace adamas
