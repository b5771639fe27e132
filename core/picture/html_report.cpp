#include "core/picture/html_report.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/picture/markup.h"

namespace adamas::picture {
namespace {

constexpr std::string_view kStyle = R"css(
:root { color-scheme: light dark; --ink: #1d1f23; --soft: #5c626b; --page: #ffffff; --panel: #f5f6f8; --line: #dfe2e7;
  --accent: #0a62a0; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e5e7ea; --soft: #a2a9b4; --page: #15171a; --panel: #1f2226; --line: #34393f; --accent: #6cb8f0; }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
main { max-width: 72rem; margin: 0 auto; padding: 2.5rem 1.25rem 4rem; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .3rem; }
h2 { font-size: 1.35rem; margin: 2.6rem 0 .8rem; padding-bottom: .3rem; border-bottom: 1px solid var(--line); }
h3 { font-size: 1.1rem; margin: 1.8rem 0 .6rem; }
h4 { font-size: 1rem; margin: 1.4rem 0 .5rem; color: var(--soft); }
p, ul { max-width: 46rem; margin: .7rem 0; overflow-wrap: anywhere; }
.subtitle { color: var(--soft); font-size: 1.05rem; }
nav ul { list-style: none; padding: 0; margin: 1.4rem 0; display: flex; flex-wrap: wrap; gap: .3rem 1.4rem; max-width: none; }
a { color: var(--accent); text-decoration: none; }
a:hover { text-decoration: underline; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(11rem, 1fr)); gap: .8rem; margin: 1.2rem 0; }
.figures > div { background: var(--panel); border: 1px solid var(--line); border-radius: .5rem; padding: .8rem 1rem; }
.figures dt { color: var(--soft); font-size: .88rem; }
.figures dd { margin: .1rem 0 0; font-size: 1.5rem; font-weight: 600; font-variant-numeric: tabular-nums; overflow-wrap: anywhere; }
.figures dd span { font-size: .95rem; font-weight: 400; color: var(--soft); }
.scroll { overflow-x: auto; margin: 1.1rem 0; }
table { border-collapse: collapse; font-size: .93rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--soft); padding-bottom: .4rem; }
th, td { padding: .38rem .85rem; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top; }
th { font-weight: 600; border-bottom-width: 2px; white-space: nowrap; }
tbody tr:hover { background: var(--panel); }
.number { text-align: right; white-space: nowrap; }
figure { margin: 1.4rem 0; }
figure img, figure video { display: block; max-width: 100%; height: auto; background: #ffffff; border: 1px solid var(--line); border-radius: .4rem; }
figure iframe { display: block; width: 100%; height: 70vh; background: #ffffff; border: 1px solid var(--line); border-radius: .4rem; box-sizing: border-box; }
figcaption { color: var(--soft); font-size: .92rem; margin-top: .5rem; max-width: 52rem; }
@media print { main { padding: 0; } h2 { break-after: avoid; } figure, tr { break-inside: avoid; } nav, figure:has(iframe) { display: none; } }
)css";

std::string escaped(std::string_view text) { return escape_markup(one_line(text)); }

// Whether a cell has the form of a number: an optional sign, digits with a decimal point, blanks or commas
// between groups, an exponent, a per cent sign.
bool is_number(std::string_view cell) {
  bool digit = false;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const char c = cell[i];
    if (c >= '0' && c <= '9')
      digit = true;
    else if (c == 'e' || c == 'E') {
      if (!digit || i + 1 == cell.size()) return false;
    } else if (std::string_view("+-., %").find(c) == std::string_view::npos)
      return false;
  }
  return digit;
}

// Whether a cell is empty; such cells may stand in a column of numbers.
bool is_blank(std::string_view cell) {
  return cell.empty() || cell == "-" || cell == "–" || cell == "n/a" || cell == "nan" || cell == "inf";
}

std::vector<bool> number_columns(const TextTable& table) {
  std::vector<bool> numbers(table.header.size());
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    bool any = false, all = true;
    for (const auto& row : table.rows) {
      any = any || is_number(row[k]);
      all = all && (is_number(row[k]) || is_blank(row[k]));
    }
    numbers[k] = any && all;
  }
  return numbers;
}

}  // namespace

HtmlReport::HtmlReport(std::string_view title, std::string_view subtitle)
    : title_(title), subtitle_(subtitle) {}

void HtmlReport::heading(std::string_view text, int level) {
  if (level < 2 || level > 4) fail("report: expected a heading of level 2 to 4, found {}", level);
  if (level > 2) {
    body_ += fmt::format("<h{0}>{1}</h{0}>\n", level, escaped(text));
    return;
  }
  const std::string id = fmt::format("section-{}", sections_.size() + 1);
  body_ += fmt::format("<h2 id=\"{}\">{}</h2>\n", id, escaped(text));
  sections_.push_back({id, std::string(text)});
}

void HtmlReport::paragraph(std::string_view text) { body_ += fmt::format("<p>{}</p>\n", escaped(text)); }

void HtmlReport::key_figures(const std::vector<KeyFigure>& figures) {
  body_ += "<dl class=\"figures\">\n";
  for (const KeyFigure& figure : figures) {
    const std::string unit = figure.unit.empty() ? "" : " <span>" + escaped(figure.unit) + "</span>";
    body_ += fmt::format("<div><dt>{}</dt><dd>{}{}</dd></div>\n", escaped(figure.label),
                         escaped(figure.value), unit);
  }
  body_ += "</dl>\n";
}

void HtmlReport::table(const TextTable& table) {
  for (const auto& row : table.rows) {
    if (row.size() != table.header.size()) {
      fail("report: table '{}': expected rows of {} cells, found one of {}", table.caption,
           table.header.size(), row.size());
    }
  }
  const std::vector<bool> numbers = number_columns(table);
  const auto row_of = [&](const std::vector<std::string>& cells, std::string_view tag) {
    std::string row = "<tr>";
    for (std::size_t k = 0; k < cells.size(); ++k) {
      row += fmt::format("<{0}{1}>{2}</{0}>", tag, numbers[k] ? " class=\"number\"" : "", escaped(cells[k]));
    }
    return row + "</tr>\n";
  };
  body_ += "<div class=\"scroll\"><table>\n";
  if (!table.caption.empty()) body_ += fmt::format("<caption>{}</caption>\n", escaped(table.caption));
  body_ += "<thead>\n" + row_of(table.header, "th") + "</thead>\n<tbody>\n";
  for (const auto& row : table.rows) body_ += row_of(row, "td");
  body_ += "</tbody>\n</table></div>\n";
}

void HtmlReport::picture(std::string_view bytes, PictureFormat format, std::string_view caption) {
  if (format == PictureFormat::kPdf) fail("report: expected a PNG or SVG picture, found PDF");
  ++pictures_;
  // Each SVG file is an image of its own, since several of them use the same ids.
  const char* type = format == PictureFormat::kPng ? "image/png" : "image/svg+xml";
  body_ += fmt::format(
      "<figure><img src=\"data:{};base64,{}\" alt=\"{}\">\n<figcaption>Figure {}. {}</figcaption></figure>\n",
      type, base64(bytes), escaped(caption), pictures_, escaped(caption));
}

void HtmlReport::film(std::string_view bytes, std::string_view extension, std::string_view caption) {
  ++pictures_;
  const std::string text = escaped(caption);
  const std::string shown =
      extension == ".gif"
          ? fmt::format("<img src=\"data:image/gif;base64,{}\" alt=\"{}\">", base64(bytes), text)
          : fmt::format("<video controls loop src=\"data:video/{};base64,{}\" aria-label=\"{}\"></video>",
                        extension == ".webm" ? "webm" : "mp4", base64(bytes), text);
  body_ +=
      fmt::format("<figure>{}\n<figcaption>Figure {}. {}</figcaption></figure>\n", shown, pictures_, text);
}

void HtmlReport::page(std::string_view html, std::string_view caption) {
  ++pictures_;
  body_ += fmt::format(
      "<figure><iframe title=\"{}\" srcdoc=\"{}\"></iframe>\n<figcaption>Figure {}. "
      "{}</figcaption></figure>\n",
      escaped(caption), escape_markup(html), pictures_, escaped(caption));
}

std::string HtmlReport::html() const {
  std::string page = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  page +=
      fmt::format("<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n<main>\n", escaped(title_), kStyle);
  page += fmt::format("<header>\n<h1>{}</h1>\n", escaped(title_));
  if (!subtitle_.empty()) page += fmt::format("<p class=\"subtitle\">{}</p>\n", escaped(subtitle_));
  page += "</header>\n";
  if (sections_.size() > 1) {
    page += "<nav><ul>\n";
    for (const Section& s : sections_)
      page += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", s.id, escaped(s.text));
    page += "</ul></nav>\n";
  }
  return page + body_ + "</main>\n</body>\n</html>\n";
}

void HtmlReport::write(const std::filesystem::path& path) const { write_bytes(path, html()); }

}  // namespace adamas::picture
