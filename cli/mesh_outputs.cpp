#include "cli/mesh_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "adamas/notes.h"
#include "cli/network_figures.h"
#include "cli/option_values.h"
#include "cli/resampling_options.h"
#include "cli/usage.h"
#include "core/io/input_file.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/output_stream.h"
#include "core/io/solver_mesh_io.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/cutting/cut_mesh.h"
#include "interfaces/cutting/cut_mesh_file.h"
#include "interfaces/cutting/cut_mesh_report.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "workflow/output/picture_block.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;
using namespace picture;

namespace {

/// Volumes of bodies count as changed when they differ by more than this part of the domain's volume.
constexpr double kVolumesRestored = 1e-9;

double tolerance_of(const CutMeshOutput& output, const ResampledMesh& mesh, double interface_error) {
  if (!output.error) return default_cut_tolerance(mesh, interface_error);
  return interface_error_of("--cut-error", *output.error, {mesh.source, mesh.box, mesh.fields, 0});
}

Figures distance_figures(const InterfaceCertificate& certificate) {
  Figures figures{{"interface_error", certificate.networks.upper},
                  {"interface_error_found", certificate.networks.lower},
                  {"interface_error_per_material", certificate.materials.upper}};
  figures["junction_error"] =
      certificate.junctions ? Figures(certificate.junctions->upper) : Figures(nullptr);
  return figures;
}

/// The bodies that the cut mesh has lost or torn, the greatest first.
std::vector<CutMeshReport::ChangedBody> changed_bodies(const CutMeshReport& report) {
  std::vector<CutMeshReport::ChangedBody> changed = report.changed;
  std::ranges::stable_sort(changed, std::greater{}, &CutMeshReport::ChangedBody::volume);
  return changed;
}

void note_changed_bodies(const CutMeshReport& report, const ResampledMesh& mesh, Console& console) {
  std::vector<std::string> notes;
  for (const auto& [body, of_mesh, of_cut, volume] : changed_bodies(report)) {
    const std::string& material = mesh.materials[mesh.table.material(body)];
    if (of_cut.pieces == 0) {
      notes.push_back(fmt::format("the cut mesh shows nothing of a body of '{}' of volume {}", material,
                                  volume_text(volume)));
    } else {
      notes.push_back(fmt::format("the cut mesh shows a body of '{}' of volume {} {}", material,
                                  volume_text(volume), topology_text(of_mesh, of_cut)));
    }
  }
  note_several(notes, {"body that it has lost or torn", "bodies that it has lost or torn"}, console);
  if (report.volume_difference > kVolumesRestored * mesh.box.volume())
    console.note("the cut mesh's bodies have the volumes of the mesh's but for {}, at most",
                 volume_text(report.volume_difference));
}

/// The distances from the input's interfaces; empty where the input is not known.
std::optional<InterfaceCertificate> compare_with_input(const ConformingMesh& cut, const ResampledMesh& mesh,
                                                       const ResamplingSource* source, double target,
                                                       const Progress& progress) {
  if (source == nullptr || source->network->triangles().empty()) return std::nullopt;
  const ExtractedInterfaces shown = interfaces_of(cut, mesh.table);
  InterfaceComparison comparison(*source, target);
  comparison.measure(shown.mesh, progress);
  return comparison.finish(shown.mesh, progress);
}

Figures report_figures(const ConformingMesh& cut, const CutMeshReport& report, const ResampledMesh& mesh,
                       const std::optional<InterfaceCertificate>& from_input) {
  std::size_t lost = 0;
  Figures wrong = Figures::array();
  for (const auto& [body, of_mesh, of_cut, volume] : changed_bodies(report)) {
    lost += of_cut.pieces == 0 ? 1 : 0;
    wrong.push_back({{"material", mesh.materials[mesh.table.material(body)]},
                     {"body", body.value},
                     {"volume", volume},
                     {"pieces_mesh", of_mesh.pieces},
                     {"pieces", of_cut.pieces},
                     {"euler_mesh", of_mesh.euler},
                     {"euler", of_cut.euler}});
  }
  return {{"tetrahedra", cut.tetrahedra.size()},
          {"vertices", cut.points.size()},
          {"dihedral_min", report.dihedral.min},
          {"dihedral_max", report.dihedral.max},
          {"to_mesh", distance_figures(report.distance)},
          {"to_input", from_input ? distance_figures(*from_input) : Figures(nullptr)},
          {"volume_difference", report.volume_difference},
          {"lost_bodies", lost},
          {"changed_bodies", report.changed.size() - lost},
          {"wrong_bodies", std::move(wrong)}};
}

void print_report(const ConformingMesh& cut, const CutMeshReport& report,
                  const std::optional<InterfaceCertificate>& from_input, Console& console) {
  std::vector<std::vector<std::string>> rows{
      {"cut mesh", ""},
      {"tetrahedra", std::to_string(cut.tetrahedra.size())},
      {"vertices", std::to_string(cut.points.size())},
      {"dihedral angles", fmt::format("{:.3g} to {:.4g} degrees", report.dihedral.min, report.dihedral.max)},
      {"distance from the mesh's interfaces", length_text(report.distance.networks.upper)}};
  if (from_input) rows.push_back({"interface error certified", length_text(from_input->networks.upper)});
  console.print("\n");
  console.table(rows);
}

}  // namespace

Ledger volume_ledger(const std::string& of, const IdVector<MaterialId, double>& volumes) {
  Ledger ledger{of, {}};
  for (const double volume : volumes) ledger.materials.push_back({volume, {}, {}});
  return ledger;
}

Figures ledger_figures(const std::vector<Ledger>& ledgers, const IdVector<MaterialId, std::string>& materials,
                       const std::vector<FieldInfo>& fields) {
  Figures rows = Figures::array();
  for (const Ledger& ledger : ledgers) {
    for (MaterialId m(0); m.value < materials.size(); ++m.value) {
      const MaterialIntegral& sums = ledger.materials[m];
      Figures integrals = Figures::object();
      for (const FieldInfo& field : fields) {
        if (sums.integral.empty()) continue;
        Figures components = Figures::array();
        for (int c = 0; c < field.components; ++c)
          components.push_back(sums.integral[field.offset + static_cast<std::size_t>(c)]);
        integrals[field.name] = field.components == 1 ? components[0] : components;
      }
      rows.push_back({{"of", ledger.of},
                      {"material", materials[m]},
                      {"volume", sums.volume},
                      {"integrals", std::move(integrals)}});
    }
  }
  return rows;
}

std::string ledger_csv(const std::vector<Ledger>& ledgers, const IdVector<MaterialId, std::string>& materials,
                       const std::vector<FieldInfo>& fields) {
  std::string text = "of,material,volume";
  for (const FieldInfo& field : fields) {
    for (int c = 0; c < field.components; ++c)
      text += "," + csv_text("integral of " + field.name +
                             (field.components > 1 ? fmt::format(" ({})", c) : std::string()));
  }
  text += "\n";
  for (const Ledger& ledger : ledgers) {
    for (MaterialId m(0); m.value < materials.size(); ++m.value) {
      const MaterialIntegral& sums = ledger.materials[m];
      text += fmt::format("{},{},{:.17g}", ledger.of, csv_text(materials[m]), sums.volume);
      for (const FieldInfo& field : fields) {
        for (int c = 0; c < field.components; ++c) {
          const std::size_t at = field.offset + static_cast<std::size_t>(c);
          const bool known = at < sums.integral.size() && !std::isnan(sums.integral[at]);
          text += known ? fmt::format(",{:.17g}", sums.integral[at]) : ",";
        }
      }
      text += "\n";
    }
  }
  return text;
}

std::string CutMeshOutput::faces() const {
  if (file_extension(file) != ".vtu") return "";
  return std::filesystem::path(file).replace_filename(file_stem(file) + "-faces.vtp").string();
}

void CutMeshOutput::declare(OutputSet& outputs) const {
  outputs.declare("--cut-mesh", file, {".vtu", ".msh", ".exo"});
  outputs.declare("--cut-mesh", faces());
  if (file.empty() && split_bodies)
    wrong_usage("--split-bodies: expected --cut-mesh FILE with it, found none");
  if (error && file.empty()) wrong_usage("--cut-error: expected --cut-mesh FILE with it, found none");
}

void add_cut_mesh_options(const Command& command, CutMeshOutput& output) {
  command
      .add_option(
          "--cut-mesh", output.file,
          "The mesh cut along its interfaces, for solvers: .vtu (with the faces between bodies beside it, "
          "in FILE-faces.vtp), .msh (Gmsh) or .exo (ExodusII)")
      .type_name("FILE");
  command
      .add_converted(
          "--cut-error",
          "How far the cut mesh's faces between materials may be from the mesh's interfaces: a length, "
          "or in % of the domain's diagonal (default: half the interface error)",
          [&output](const std::string& option, const std::string& text) {
            output.error = parse_error_target(option, text);
          })
      .type_name("E|E%");
  command.add_flag(
      "--split-bodies", output.split_bodies,
      "Bodies of the cut mesh share no points, as for contact (default: they share them, and the "
      "mesh has no cracks)");
}

Figures write_cut_mesh(const CutMeshOutput& output, const ResampledMesh& mesh, double interface_error,
                       const ResamplingSource* source, std::vector<Ledger>& ledgers, Session& session) {
  if (output.file.empty()) return nullptr;
  Console& console = session.console;
  const double tolerance = tolerance_of(output, mesh, interface_error);
  const ConformingMesh cut = cut_mesh(mesh, tolerance, console);
  console.step("measuring the cut mesh", -1);
  const CutMeshReport report = examine_cut_mesh(cut, mesh, tolerance, console);
  const auto from_input =
      compare_with_input(cut, mesh, source, std::max(interface_error, tolerance), console);
  print_report(cut, report, from_input, console);
  note_changed_bodies(report, mesh, console);
  const SolverMesh written =
      to_solver_mesh(cut, mesh, output.split_bodies ? PointsOfBodies::kSplit : PointsOfBodies::kShared);
  ledgers.push_back({"cut mesh", material_integrals(written)});
  console.step("writing " + output.file, -1);
  session.outputs.write(output.file, [&](const auto& path) { write_solver_mesh(path, written); });
  session.outputs.write(output.faces(),
                        [&](const auto& path) { write_unstructured_mesh(path, face_surface(written)); });
  return report_figures(cut, report, mesh, from_input);
}

void MeshOutputs::declare(OutputSet& outputs) const {
  picture.check();
  outputs.declare("-o", mesh, {".vtu"});
  outputs.declare("--interfaces-out", interfaces, {".vtp", ".ply", ".obj", ".off", ".stl", ".arec", ".txt"});
  cut.declare(outputs);
  outputs.declare("--ledger", ledger, {".csv"});
  outputs.declare("--picture", picture.file, {".png", ".svg", ".pdf", ".html"});
}

void add_mesh_output_options(const Command& command, MeshOutputs& outputs, bool series) {
  command
      .add_option("-o,--output", outputs.mesh, series ? "The mesh: .vtu; of a series .pvd" : "The mesh: .vtu")
      .type_name("FILE");
  command
      .add_option("--interfaces-out", outputs.interfaces,
                  "The approximated interfaces: .vtp, .ply, .obj, .off, .stl or .arec")
      .type_name("FILE");
  add_cut_mesh_options(command, outputs.cut);
  command
      .add_option("--ledger", outputs.ledger,
                  "Volumes and integrals of fields per material, of the input and of what is written: .csv")
      .type_name("FILE");
  outputs.picture.drawing.triangle_edges = true;
  add_surface_picture_options(command, outputs.picture);
}

void write_interfaces(const MeshOutputs& outputs, const InterfaceMesh& interfaces, const Box3& box,
                      const std::function<ResampledMesh()>& mesh, Session& session) {
  session.console.step("writing interfaces", -1);
  session.outputs.write(outputs.interfaces,
                        [&](const auto& path) { write_interface_mesh(path, interfaces); });
  session.outputs.write(outputs.picture.file, [&](const auto& path) {
    std::optional<PictureBlock> block;
    if (workflow::turns(outputs.picture.file)) block = workflow::picture_block(mesh());
    workflow::write_surface_picture(path, interfaces, box, outputs.picture.drawing, std::move(block));
  });
}

Figures write_mesh(const MeshOutputs& outputs, const ResampledMesh& mesh, double interface_error,
                   const ResamplingSource* source, std::vector<Ledger>& ledgers, Session& session) {
  ledgers.push_back({"mesh", material_integrals(mesh)});
  session.outputs.write(outputs.mesh, [&](const auto& path) {
    session.console.step("writing " + outputs.mesh, -1);
    write_unstructured_mesh(path, to_unstructured_mesh(mesh));
  });
  Figures cut = write_cut_mesh(outputs.cut, mesh, interface_error, source, ledgers, session);
  session.outputs.write(outputs.ledger, [&](const auto& path) {
    OutputStream stream(path);
    stream.write(ledger_csv(ledgers, mesh.materials, mesh.fields));
    stream.finish();
  });
  return cut;
}

}  // namespace adamas::cli
