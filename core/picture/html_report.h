#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "adamas/text_table.h"
#include "core/picture/picture_file.h"

namespace adamas::picture {

/// A number that deserves to be seen at a glance.
struct KeyFigure {
  std::string label{};
  std::string value{};
  std::string unit{};
};

/// Builds a report as one HTML file that needs nothing else: pictures are embedded, and there are no outside
/// references. All text is escaped. Readable on small screens, in light and dark, and on paper.
class HtmlReport {
 public:
  explicit HtmlReport(std::string_view title, std::string_view subtitle = {});

  /// Adds a section's heading; those of level 2 make the table of contents. Throws Error for a level
  /// outside 2..4.
  void heading(std::string_view text, int level = 2);
  void paragraph(std::string_view text);
  void key_figures(const std::vector<KeyFigure>& figures);
  /// Adds a table; columns whose cells are all numbers are set to the right. Throws Error for a row with more
  /// or fewer cells than the header.
  void table(const TextTable& table);
  /// Adds a picture by the bytes of a PNG or SVG file. Throws Error for PDF.
  void picture(std::string_view bytes, PictureFormat format, std::string_view caption);
  /// Adds a film by the bytes of a file as Film makes them; `extension` tells its kind.
  void film(std::string_view bytes, std::string_view extension, std::string_view caption);
  /// Adds a page within the report, as turning_page makes it: the only scripts that a report has.
  void page(std::string_view html, std::string_view caption);

  [[nodiscard]] std::string html() const;
  /// Writes the report through OutputFile; throws Error when the file cannot be written.
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
