#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "adamas/text_table.h"
#include "core/picture/picture_file.h"

namespace adamas::picture {

/// A number that is shown large at the top.
struct KeyFigure {
  std::string label{};
  std::string value{};
  std::string unit{};
};

/// Builds a report as one self-contained HTML file: pictures are embedded, and there are no outside
/// references. All text is escaped. It is readable on small screens, in light and dark mode, and on paper.
class HtmlReport {
 public:
  explicit HtmlReport(std::string_view title, std::string_view subtitle = {});

  /// Adds a section's heading; headings of level 2 form the table of contents. Throws Error for a level
  /// outside 2..4.
  void heading(std::string_view text, int level = 2);
  void paragraph(std::string_view text);
  void key_figures(const std::vector<KeyFigure>& figures);
  /// Adds a table; columns whose cells are all numbers are right-aligned. Throws Error for a row with more or
  /// fewer cells than the header.
  void table(const TextTable& table);
  /// Adds a picture by the bytes of a PNG or SVG file. Throws Error for PDF.
  void picture(std::string_view bytes, PictureFormat format, std::string_view caption);
  /// Adds a film by the bytes of a file that Film made; `extension` gives its format.
  void film(std::string_view bytes, std::string_view extension, std::string_view caption);
  /// Adds a page within the report, as turning_page makes it; a report has no other scripts.
  void page(std::string_view html, std::string_view caption);

  [[nodiscard]] std::string html() const;
  /// Writes the report through OutputFile; throws Error if the file cannot be written.
  void write(const std::filesystem::path& path) const;

 private:
  struct Section {
    std::string id, text;
  };
  std::string title_, subtitle_, body_;
  std::vector<Section> sections_;
  int pictures_ = 0;
};

}  // namespace adamas::picture
