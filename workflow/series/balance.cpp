#include "workflow/series/balance.h"

#include <algorithm>
#include <cctype>
#include <limits>

#include "core/base/error.h"
#include "interfaces/api/error_targets.h"
#include "interfaces/cross_section/field_choice.h"

namespace adamas::workflow {

using namespace interfaces;

namespace {

bool same_letters(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

}  // namespace

std::string density_field(const std::string& name, const std::vector<FieldInfo>& fields,
                          const std::string& source) {
  for (const FieldInfo& info : fields) {
    if (name.empty() ? same_letters(info.name, "density") : info.name == name) {
      if (info.components == 1) return info.name;
      fail("{}: --density: expected a scalar field, found '{}' with {} components", source, info.name,
           info.components);
    }
  }
  if (name.empty()) return {};
  fail("{}: --density: expected one of its fields ({}), found '{}'", source, field_names(fields), name);
}

std::vector<FieldRange> summarize(const std::vector<FieldInfo>& fields) {
  std::vector<FieldRange> result;
  for (const FieldInfo& field : fields)
    result.push_back({field.name, field.unit, field.components, field.min, field.max});
  return result;
}

std::vector<MaterialBalance> balance_of(const IdVector<MaterialId, std::string>& materials,
                                        const IdVector<MaterialId, MaterialIntegral>& input,
                                        const IdVector<MaterialId, MaterialIntegral>& mesh,
                                        std::optional<std::size_t> mass_input,
                                        std::optional<std::size_t> mass_mesh) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<MaterialBalance> balance;
  for (MaterialId m(0); m.value < materials.size(); ++m.value) {
    balance.push_back({materials[m], input[m].volume, mesh[m].volume,
                       mass_input ? input[m].integral[*mass_input] : kNone,
                       mass_mesh ? mesh[m].integral[*mass_mesh] : kNone});
  }
  return balance;
}

std::vector<MaterialBalance> balance_of(const MultiMaterialData& data, const ResampledMesh& mesh,
                                        const std::string& density) {
  std::optional<std::size_t> in, out;
  if (!density.empty()) {
    const std::vector<FieldInfo> fields = field_infos(data);
    in = fields[find_field(fields, density, data.source).field].offset;
    out = mesh.fields[find_field(mesh.fields, density, mesh.source).field].offset;
  }
  return balance_of(data.materials, material_integrals(data), material_integrals(mesh), in, out);
}

}  // namespace adamas::workflow
