// Tests restore -o F.zarr: the contents of the folder, and what is refused. read_zarr.py reads the samples.

#include <map>

#include "store_test.h"

namespace adamas::test {

namespace {

namespace fs = std::filesystem;

class OmeZarrOutput : public StoreTest {
 protected:
  /// Returns the files in a folder, with their bytes.
  [[nodiscard]] std::map<std::string, std::string> content(const std::string& name) const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder() / name)) {
      if (!entry.is_regular_file()) continue;
      all[fs::relative(entry.path(), folder() / name).string()] =
          read(fs::relative(entry.path(), folder()).string());
    }
    return all;
  }
  /// Makes the store s.adm of three steps of 9^3 samples at these times.
  void make_series(const std::vector<std::string>& times) const {
    std::string list = "<VTKFile type=\"Collection\"><Collection>";
    for (std::size_t n = 0; n < times.size(); ++n) {
      const std::string name = "s" + std::to_string(n) + ".vti";
      run_well({"generate", "buckyball", "--dimensions", "9", "-o", name, "-q"});
      list += "<DataSet timestep=\"" + times[n] + "\" file=\"" + name + "\"/>";
    }
    write("s.pvd", list + "</Collection></VTKFile>");
    run_well({"store", "s.pvd", "-o", "s.adm", "-q"});
  }
  [[nodiscard]] nlohmann::json attributes(const std::string& name) const {
    return nlohmann::json::parse(read(name + "/.zattrs"));
  }
};

TEST_F(OmeZarrOutput, EverySecondSampleDownToOneChunk) {
  make_ball("100,140,33");
  make_store();
  run_well({"restore", "b.adm", "-o", "b.ome.zarr/", "--json", "f.json", "-q"});
  EXPECT_EQ(read_json("f.json")["levels"], 3);
  const auto multiscale = attributes("b.ome.zarr")["multiscales"][0];
  EXPECT_EQ(multiscale["name"], "b");
  EXPECT_EQ(multiscale["axes"].size(), 3u);
  EXPECT_EQ(multiscale["datasets"].size(), 3u);
  const auto header = nlohmann::json::parse(read("b.ome.zarr/2/.zarray"));
  EXPECT_EQ(header["shape"], (std::vector<int>{9, 35, 25}));
  EXPECT_EQ(header["chunks"], header["shape"]);
  EXPECT_EQ(content("b.ome.zarr/0").size(), 1u + 1 * 3 * 2);
}

TEST_F(OmeZarrOutput, IsTheSameWhateverTheThreadsAndTheMemory) {
  make_ball("70,40,20");
  make_store();
  run_well({"restore", "b.adm", "-o", "a.zarr", "--threads", "1", "-q"});
  run_well({"restore", "b.adm", "-o", "b.zarr", "--threads", "3", "--memory", "1", "-q"});
  for (auto& [name, bytes] : content("a.zarr"))
    EXPECT_TRUE(name == ".zattrs" || bytes == read("b.zarr/" + name)) << name;
  EXPECT_EQ(content("a.zarr").size(), content("b.zarr").size());
}

TEST_F(OmeZarrOutput, TimesAreAScaleWhereTheyAreEven) {
  make_series({"2", "2.5", "3"});
  run_well({"restore", "s.adm", "-o", "s.zarr", "-q"});
  const auto found = attributes("s.zarr");
  EXPECT_EQ(found["adamas"]["times"], (std::vector<double>{2, 2.5, 3}));
  const auto places = found["multiscales"][0]["datasets"][0]["coordinateTransformations"];
  EXPECT_EQ(places[0]["scale"][0], 0.5);
  EXPECT_EQ(places[1]["translation"][0], 2);
  run_well({"restore", "s.adm", "--step", "1", "-o", "one.zarr", "-q"});
  EXPECT_EQ(attributes("one.zarr")["multiscales"][0]["axes"].size(), 3u);
  run_well({"restore", "s.adm", "--steps", "1,1", "-o", "part.zarr", "-q"});
  EXPECT_EQ(attributes("part.zarr")["adamas"]["times"], std::vector<double>{2.5});
}

TEST_F(OmeZarrOutput, UnevenTimesAreToldOf) {
  make_series({"0", "1", "4"});
  const RunResult result = run({"restore", "s.adm", "-o", "s.zarr"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
  EXPECT_NE(result.err.find("times of steps are uneven"), std::string::npos) << result.err;
  const auto found = attributes("s.zarr");
  EXPECT_EQ(found["adamas"]["times"], (std::vector<double>{0, 1, 4}));
  EXPECT_EQ(found["multiscales"][0]["datasets"][0]["coordinateTransformations"][0]["scale"][0], 1);
}

TEST_F(OmeZarrOutput, AxesThatTurnAndScalesAreToldOf) {
  write("t.nrrd",
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nspace: left-posterior-superior\n"
        "space directions: (0,2,0) (-3,0,0) (0,0,1)\nspace origin: (5,6,7)\n\nabcdefgh");
  run_well({"store", "t.nrrd", "-o", "t.adm", "-q"});
  const RunResult result = run({"restore", "t.adm", "-o", "t.zarr"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("axes do not run along x, y and z"), std::string::npos) << result.err;
  const auto found = attributes("t.zarr");
  EXPECT_EQ(found["adamas"]["space"], "LPS");
  EXPECT_EQ(found["adamas"]["directions"][1], (std::vector<double>{-1, 0, 0}));
  const auto places = found["multiscales"][0]["datasets"][0]["coordinateTransformations"];
  EXPECT_EQ(places[0]["scale"], (std::vector<double>{1, 3, 2}));
  EXPECT_EQ(places[1]["translation"], (std::vector<double>{7, 6, 5}));
}

TEST_F(OmeZarrOutput, FoldersThatAreThere) {
  make_ball("10");
  make_store();
  fs::create_directory(folder() / "empty.zarr");
  run_well({"restore", "b.adm", "-o", "empty.zarr", "-q"});
  const auto before = content("empty.zarr");
  expect_failure({"restore", "b.adm", "-o", "empty.zarr"}, {"empty.zarr", "--overwrite"});
  run_well({"restore", "b.adm", "-o", "empty.zarr", "--overwrite", "-q"});
  EXPECT_EQ(content("empty.zarr"), before);
  fs::create_directory(folder() / "other.zarr");
  write("other.zarr/mine", "1");
  expect_failure({"restore", "b.adm", "-o", "other.zarr", "--overwrite"}, {"other.zarr", ".adamas-files"});
  write("file.zarr", "1");
  expect_failure({"restore", "b.adm", "-o", "file.zarr"}, {"file.zarr", "found a file"});
  expect_failure({"restore", "b.adm", "-o", "none/b.zarr"}, {"none/b.zarr", "existing folder"});
  write("empty.zarr/labels", "1");
  expect_failure({"restore", "b.adm", "-o", "empty.zarr", "--overwrite"}, {"empty.zarr", "found 'labels'"});
  fs::remove(folder() / "empty.zarr/labels");
  fs::rename(folder() / "b.adm", folder() / "empty.zarr/b.adm");
  expect_wrong_usage({"restore", "empty.zarr/b.adm", "-o", "empty.zarr", "--overwrite"},
                     {"expected a folder without the input, found empty.zarr/b.adm"});
  fs::create_directory_symlink("nowhere", folder() / "link.zarr");
  expect_failure({"restore", "empty.zarr/b.adm", "-o", "link.zarr"},
                 {"link.zarr", "a link that leads to none"});
  expect_wrong_usage({"restore", "empty.zarr/b.adm", "-o", "b.vti", "--overwrite"}, {"--overwrite", "b.vti"});
}

TEST_F(OmeZarrOutput, NothingIsLeftOfWhatFailed) {
  make_ball("40", "float32");
  make_store();
  RunOptions full;
  full.file_size_limit = 3000;
  expect_failure({"restore", "b.adm", "-o", "b.zarr"}, {"b.zarr/0/0/0/0", "could not be written"}, full);
  write("cut.adm", read("b.adm").substr(0, read("b.adm").size() / 2));
  expect_failure({"restore", "cut.adm", "-o", "b.zarr"}, {"cut.adm"});
  expect_failure({"restore", "b.adm", "--level", "9", "-o", "b.zarr"}, {"b.adm", "LOD from 0 to 3"});
  expect_failure({"restore", "b.adm", "--region", "90,91,0,1,0,1", "-o", "b.zarr"}, {"b.adm", "a region"});
}

}  // namespace

}  // namespace adamas::test
