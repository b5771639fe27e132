#include "cli/mesh_outputs.h"

#include <fmt/format.h>

#include <utility>

#include "adamas/file_names.h"
#include "adamas/files.h"
#include "adamas/mesh_files.h"
#include "adamas/notes.h"
#include "adamas/turning_picture.h"
#include "cli/option_values.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

/// A body's volume counts as changed when it differs by more than this part of the domain's volume.
constexpr double kVolumesRestored = 1e-9;

Figures distance_figures(const InterfaceDistances& distances) {
  return {
      {"interface_error", distances.interfaces.certified},
      {"interface_error_found", distances.interfaces.found},
      {"interface_error_per_material", distances.per_material.certified},
      {"junction_error", distances.junctions ? Figures(distances.junctions->certified) : Figures(nullptr)}};
}

void note_changed_bodies(const CutMeshReport& report, const AdaptiveMesh& mesh, Console& console) {
  std::vector<std::string> notes;
  for (const CutMeshReport::Body& body : report.changed_bodies) {
    const std::string& material = mesh.materials()[body.material];
    const bool lost = body.topology.pieces == 0;
    notes.push_back(fmt::format("the cut mesh shows {}a body of '{}' of volume {}{}",
                                lost ? "nothing of " : "", material, volume_text(body.volume),
                                lost ? "" : " " + topology_text(body.topology_mesh, body.topology)));
  }
  note_several(notes, {"body that it has lost or torn", "bodies that it has lost or torn"}, console);
  if (report.volume_difference > kVolumesRestored * mesh.domain().volume())
    console.note("the cut mesh's bodies have the volumes of the mesh's but for {}, at most",
                 volume_text(report.volume_difference));
}

Figures report_figures(const CutMeshReport& report, const AdaptiveMesh& mesh) {
  std::size_t lost = 0;
  Figures wrong = Figures::array();
  for (const CutMeshReport::Body& body : report.changed_bodies) {
    lost += body.topology.pieces == 0 ? 1 : 0;
    wrong.push_back({{"material", mesh.materials()[body.material]},
                     {"body", body.body},
                     {"volume", body.volume},
                     {"pieces_mesh", body.topology_mesh.pieces},
                     {"pieces", body.topology.pieces},
                     {"euler_mesh", body.topology_mesh.euler},
                     {"euler", body.topology.euler}});
  }
  return {{"tetrahedra", report.tetrahedra},
          {"vertices", report.vertices},
          {"dihedral_min", report.dihedral_min},
          {"dihedral_max", report.dihedral_max},
          {"to_mesh", distance_figures(report.to_mesh)},
          {"to_input", report.to_input ? distance_figures(*report.to_input) : Figures(nullptr)},
          {"volume_difference", report.volume_difference},
          {"lost_bodies", lost},
          {"changed_bodies", report.changed_bodies.size() - lost},
          {"wrong_bodies", std::move(wrong)}};
}

void print_report(const CutMeshReport& report, Console& console) {
  std::vector<std::vector<std::string>> rows{
      {"cut mesh", ""},
      {"tetrahedra", std::to_string(report.tetrahedra)},
      {"vertices", std::to_string(report.vertices)},
      {"dihedral angles", fmt::format("{:.3g} to {:.4g} degrees", report.dihedral_min, report.dihedral_max)},
      {"distance from the mesh's interfaces", length_text(report.to_mesh.interfaces.certified)}};
  if (report.to_input)
    rows.push_back({"interface error certified", length_text(report.to_input->interfaces.certified)});
  console.print("\n");
  console.table(rows);
}

Figures write_cut_mesh(const CutMeshOutput& output, const AdaptiveMesh& mesh, const MaterialColours& colours,
                       std::vector<Ledger>& ledgers, Session& session) {
  if (output.file.empty()) return nullptr;
  Console& console = session.console;
  const CutMesh cut = cut_mesh(mesh, output.options, console);
  print_report(cut.report(), console);
  note_changed_bodies(cut.report(), mesh, console);
  ledgers.push_back({"cut mesh", material_totals(cut)});
  console.step("writing " + output.file, -1);
  session.outputs.write(output.file, [&](const auto& path) { write_mesh(path, cut, colours); });
  session.outputs.write(output.faces(), [&](const auto& path) { write_faces(path, cut); });
  return report_figures(cut.report(), mesh);
}

void add_cut_mesh_options(const Command& command, CutMeshOutput& output) {
  command.add_option(
      "--cut-mesh", "FILE",
      "The mesh cut along its interfaces, for solvers: .vtu (with the faces between bodies beside it, "
      "in FILE-faces.vtp), .vtkhdf, .msh (Gmsh) or .exo (ExodusII)",
      output.file);
  command.add_value("--cut-error", "E|E%",
                    "How far the cut mesh's faces between materials may be from the mesh's interfaces: a "
                    "length, or in % of the domain's diagonal (default: half the interface error)",
                    output.options.error, [](const std::string& option, const std::string& text) {
                      return parse_error_target(option, text);
                    });
  command.add_flag(
      "--split-bodies",
      "Bodies of the cut mesh share no points, as for contact (default: they share them, and the "
      "mesh has no cracks)",
      output.options.split_bodies);
}

}  // namespace

std::string CutMeshOutput::faces() const {
  if (file_extension(file) != ".vtu") return "";
  return std::filesystem::path(file).replace_filename(file_stem(file) + "-faces.vtp").string();
}

void CutMeshOutput::declare(OutputSet& outputs) const {
  outputs.declare("--cut-mesh", file, {".vtu", ".vtkhdf", ".msh", ".exo"});
  outputs.declare("--cut-mesh", faces());
  if (file.empty() && options.split_bodies)
    wrong_usage("--split-bodies: expected --cut-mesh FILE with it, found none");
  if (options.error && file.empty()) wrong_usage("--cut-error: expected --cut-mesh FILE with it, found none");
}

void MeshOutputs::declare(OutputSet& outputs) const {
  picture.check();
  outputs.declare("-o", mesh, {".vtu", ".vtkhdf"});
  outputs.declare("--interfaces-out", interfaces, {".vtp", ".ply", ".obj", ".off", ".stl", ".arec", ".txt"});
  cut.declare(outputs);
  outputs.declare("--ledger", ledger, {".csv"});
  outputs.declare("--picture", picture.file, {".png", ".svg", ".pdf", ".html"});
}

void add_mesh_output_options(const Command& command, MeshOutputs& outputs, bool series) {
  command.add_option("-o,--output", "FILE",
                     series ? "The mesh: .vtu, or .vtkhdf for other programs; of a series .pvd"
                            : "The mesh: .vtu, or .vtkhdf for other programs",
                     outputs.mesh);
  command.add_option("--interfaces-out", "FILE",
                     "The approximated interfaces: .vtp, .ply, .obj, .off, .stl or .arec",
                     outputs.interfaces);
  add_cut_mesh_options(command, outputs.cut);
  command.add_option(
      "--ledger", "FILE",
      "Volumes and integrals of fields per material, of the input and of what is written: .csv",
      outputs.ledger);
  outputs.picture.drawing.triangle_edges = true;
  add_surface_picture_options(command, outputs.picture);
}

void write_interfaces(const MeshOutputs& outputs, const InterfaceTriangles& interfaces,
                      const AdaptiveMesh& mesh, Session& session) {
  session.console.step("writing interfaces", -1);
  session.outputs.write(outputs.interfaces,
                        [&](const auto& path) { write_mesh(path, interfaces, outputs.colours); });
  session.outputs.write(outputs.picture.file, [&](const auto& path) {
    DrawingOptions drawing = outputs.picture.drawing;
    drawing.domain = mesh.domain();
    drawing.colours = outputs.colours;
    write_picture(path, interfaces, mesh, drawing);
  });
}

Figures write_meshes(const MeshOutputs& outputs, const AdaptiveMesh& mesh, std::vector<Ledger>& ledgers,
                     Session& session) {
  ledgers.push_back({"mesh", material_totals(mesh)});
  session.outputs.write(outputs.mesh, [&](const auto& path) {
    session.console.step("writing " + outputs.mesh, -1);
    write_mesh(path, mesh, outputs.colours);
  });
  Figures cut = write_cut_mesh(outputs.cut, mesh, outputs.colours, ledgers, session);
  session.outputs.write(outputs.ledger,
                        [&](const auto& path) { write_text(path, ledger_csv(ledgers, mesh.fields())); });
  return cut;
}

}  // namespace adamas::cli
