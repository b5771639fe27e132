// Tests units of lengths and of values, which go through stores.

#include <fmt/format.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStringArray.h>
#include <vtkXMLImageDataReader.h>

#include <cstddef>

#include "tests/cli/program.h"
#include "tests/support/scratch.h"

namespace adamas {

namespace {

using test::says;

class Units : public test::ProgramTest {
 protected:
  /// Writes 4 x 3 x 5 samples as NRRD with further lines in its header.
  void write_nrrd(const std::string& name, const std::string& lines) const {
    std::string samples;
    for (int i = 0; i < 60; ++i) samples += static_cast<char>(7 * i);
    write(name, "NRRD0005\ntype: uint8\ndimension: 3\nspace dimension: 3\nsizes: 4 3 5\nencoding: raw\n" +
                    lines + "\n" + samples);
  }
};

TEST_F(Units, AStoreGivesBackThoseOfItsFile) {
  write_nrrd("ct.nrrd", "space units: \"um\" \"um\" \"um\"\nsample units: HU (air 0)\n");
  const auto seen = run_well({"info", "ct.nrrd", "--json", "file.json"});
  EXPECT_TRUE(says(seen.out, "lengths are in um and values are in HU (air 0)"));
  EXPECT_EQ(read_json("file.json")["length_unit"], "um");
  run_well({"store", "ct.nrrd", "-o", "ct.adm", "-q"});
  EXPECT_TRUE(says(run_well({"info", "ct.adm", "--json", "store.json"}).out,
                   "lengths are in um and values are in HU (air 0)"));
  EXPECT_EQ(read_json("store.json")["value_unit"], "HU (air 0)");
  run_well({"restore", "ct.adm", "-o", "back.nrrd", "-q"});
  const std::string header = read("back.nrrd");
  EXPECT_TRUE(says(header, "\nspace units: \"um\" \"um\" \"um\"\n"));
  EXPECT_TRUE(says(header, "\nsample units: HU (air 0)\n"));
  // What the header says is read again.
  run_well({"store", "back.nrrd", "-o", "again.adm", "-q"});
  run_well({"info", "again.adm", "--json", "again.json"});
  EXPECT_EQ(read_json("again.json")["length_unit"], "um");
  EXPECT_EQ(read_json("again.json")["value_unit"], "HU (air 0)");
}

TEST_F(Units, NiftiHasACodeForThem) {
  for (const auto& [unit, code] : {std::pair("m", 1), std::pair("mm", 2), std::pair("um", 3)}) {
    write_nrrd("a.nrrd", fmt::format("space units: \"{0}\" \"{0}\" \"{0}\"\n", unit));
    run_well({"store", "a.nrrd", "-o", "a.adm", "-q"});
    run_well({"restore", "a.adm", "-o", "a.nii", "-q"});
    constexpr std::size_t kUnits = 123;
    EXPECT_EQ(read("a.nii").at(kUnits) & 7, code);
    run_well({"info", "a.nii", "--json", "a.json"});
    EXPECT_EQ(read_json("a.json")["length_unit"], unit);
  }
}

TEST_F(Units, OmeZarrHasWordsForThem) {
  write_nrrd("a.nrrd", "units: \"mm\" \"mm\" \"mm\"\n");
  run_well({"store", "a.nrrd", "-o", "a.adm", "-q"});
  run_well({"restore", "a.adm", "-o", "a.zarr", "-q"});
  const auto attributes = read_json("a.zarr/.zattrs");
  for (const auto& axis : attributes["multiscales"][0]["axes"]) EXPECT_EQ(axis["unit"], "millimeter");
}

/// What VTK has no words for is in the field data of a .vti, and comes back.
TEST_F(Units, FilesOfVtkKeepThem) {
  write_nrrd("a.nrrd", "space units: \"inch\" \"inch\" \"inch\"\nsample units: K\n");
  run_well({"store", "a.nrrd", "-o", "a.adm", "-q"});
  EXPECT_EQ(run_well({"restore", "a.adm", "-o", "a.vti", "-q"}).err, "");
  run_well({"store", "a.vti", "-o", "b.adm", "-q"});
  const vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName((folder() / "a.vti").c_str());
  reader->Update();
  auto* text =
      vtkStringArray::SafeDownCast(reader->GetOutput()->GetFieldData()->GetAbstractArray("length_unit"));
  ASSERT_NE(text, nullptr);
  EXPECT_EQ(text->GetValue(0), "inch");
  for (const std::string file : {"a.vti", "b.adm"}) {
    run_well({"info", file, "--json", "a.json"});
    EXPECT_EQ(read_json("a.json")["length_unit"], "inch") << file;
    EXPECT_EQ(read_json("a.json")["value_unit"], "K") << file;
  }
}

TEST_F(Units, ANoteTellsOfThoseThatAFormatCannotTell) {
  write_nrrd("a.nrrd", "space units: \"inch\" \"inch\" \"inch\"\nsample units: K\n");
  run_well({"store", "a.nrrd", "-o", "a.adm", "-q"});
  const auto notes = run({"restore", "a.adm", "-o", "a.mha"});
  EXPECT_EQ(notes.status, 0);
  EXPECT_TRUE(says(notes.err, "a.mha: the unit of length, inch, and that of values, K, is not kept"));
}

TEST_F(Units, AxesOfDifferentUnitsHaveNone) {
  write_nrrd("a.nrrd", "space units: \"mm\" \"mm\" \"cm\"\n");
  run_well({"store", "a.nrrd", "-o", "a.adm", "-q"});
  run_well({"info", "a.adm", "--json", "a.json"});
  EXPECT_TRUE(read_json("a.json")["length_unit"].is_null());
  // Nor has a unit that would not be one.
  write_nrrd("b.nrrd", "sample units: " + std::string(300, 'x') + "\n");
  run_well({"info", "b.nrrd", "--json", "b.json"});
  EXPECT_TRUE(read_json("b.json")["value_unit"].is_null());
}

}  // namespace
}  // namespace adamas
