#include "cli/mesh_outputs.h"

#include <nlohmann/json.hpp>

#include "core/io/interface_mesh_io.h"
#include "core/io/output_stream.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/mesh/resampled_mesh_file.h"

namespace adamas {

void MeshOutputs::declare(OutputSet& outputs) const {
  picture.check();
  outputs.declare("-o", mesh, {".vtu"});
  outputs.declare("--interfaces-out", interfaces, {".vtp", ".ply", ".obj", ".off", ".stl", ".arec", ".txt"});
  cut.declare(outputs);
  outputs.declare("--ledger", ledger, {".csv"});
  outputs.declare("--picture", picture.camera.file, {".png", ".svg", ".pdf"});
}

void add_mesh_output_options(const Command& command, MeshOutputs& outputs) {
  command.add_option("-o,--output", outputs.mesh, "The mesh: .vtu").type_name("FILE");
  command
      .add_option("--interfaces-out", outputs.interfaces,
                  "The approximated interfaces: .vtp, .ply, .obj, .off, .stl or .arec")
      .type_name("FILE");
  add_cut_mesh_options(command, outputs.cut);
  command
      .add_option("--ledger", outputs.ledger,
                  "Volumes and integrals of fields per material, of the input and of what is written: .csv")
      .type_name("FILE");
  outputs.picture.triangle_edges = true;
  add_surface_picture_options(command, outputs.picture);
}

void write_interfaces(const MeshOutputs& outputs, const InterfaceMesh& interfaces, const Box3& box,
                      Session& session) {
  session.console.step("writing interfaces", -1);
  session.outputs.write(outputs.interfaces,
                        [&](const auto& path) { write_interface_mesh(path, interfaces); });
  session.outputs.write(outputs.picture.camera.file, [&](const auto& path) {
    write_surface_picture(path, interfaces, box, outputs.picture);
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

}  // namespace adamas
