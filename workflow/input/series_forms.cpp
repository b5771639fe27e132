#include "workflow/input/series_forms.h"

#include <algorithm>

#include "adamas/text.h"
#include "core/base/error.h"
#include "interfaces/api/error_targets.h"
#include "interfaces/cross_section/field_choice.h"

namespace adamas::workflow {

using namespace interfaces;

namespace {

std::string sites_text(const RectilinearGrid& grid) {
  return fmt::format("{} x {} x {} {}", grid.sites(0), grid.sites(1), grid.sites(2),
                     grid.centering == Centering::kCells ? "cells" : "points");
}

std::string materials_text(const IdVector<MaterialId, std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

bool same_form(const FieldInfo& a, const FieldInfo& b) {
  return a.name == b.name && a.components == b.components;
}

}  // namespace

void SeriesForms::check(const std::string& file, const MultiMaterialData& data) {
  const bool is_first = first_.empty();
  if (is_first) {
    grid_ = data.grid;
    fields_ = field_infos(data);
  }
  if (sites_text(data.grid) != sites_text(grid_))
    fail("{}: expected {} as {} has, found {}", file, sites_text(grid_), first_, sites_text(data.grid));
  check(file, data.materials, data.grid.domain());
  if (data.grid.nodes != grid_.nodes)
    fail("{}: expected the coordinates of the grid of {}, found others", file, first_);
  check_fields(file, field_infos(data));
}

void SeriesForms::check(const std::string& file, const MeshData& data, const std::vector<FieldInfo>& fields) {
  if (first_.empty()) fields_ = fields;
  check(file, data.materials, data.mesh.box());
  check_fields(file, fields);
}

void SeriesForms::check_fields(const std::string& file, const std::vector<FieldInfo>& fields) const {
  if (!std::equal(fields.begin(), fields.end(), fields_.begin(), fields_.end(), same_form))
    fail("{}: expected the fields of {} ({}), found {}", file, first_, field_names(fields_),
         field_names(fields));
}

void SeriesForms::check(const std::string& file, const IdVector<MaterialId, std::string>& materials,
                        const Box3& box) {
  if (first_.empty()) {
    first_ = file;
    box_ = box;
    materials_ = materials;
  }
  if (box.min != box_.min || box.max != box_.max)
    fail("{}: expected the box of {}, {}, found {}", file, first_, box_text(box_), box_text(box));
  if (materials != materials_)
    fail("{}: expected the materials of {} ({}), found {}", file, first_, materials_text(materials_),
         materials_text(materials));
}

}  // namespace adamas::workflow
