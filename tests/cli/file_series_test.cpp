// Tests series that lie in one file: NIfTI with several times, groups and four-dimensional arrays of HDF5.

#include <algorithm>
#include <cstring>
#include <limits>

#include "program.h"
#include "tests/support/hdf5_file.h"

namespace adamas::test {

namespace {

class FileSeries : public ProgramTest {
 protected:
  static constexpr std::uint64_t kSamples = 4 * 3 * 2;

  /// Returns the samples of a step, which differ from those of all other steps.
  static std::vector<std::uint8_t> samples(int step) {
    std::vector<std::uint8_t> values(kSamples);
    for (std::size_t n = 0; n < kSamples; ++n)
      values[n] = static_cast<std::uint8_t>(n * 7 + n / 4 + 40u * step);
    return values;
  }
  static std::string text(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

  /// Writes a NIfTI file with several times, `spacing` apart in a unit of the format.
  void write_nifti(const std::string& name, std::int16_t times, float spacing, char unit) const {
    std::string bytes(352, '\0');
    const auto put = [&bytes](std::size_t at, auto value) { std::memcpy(&bytes[at], &value, sizeof(value)); };
    put(0, std::int32_t{348});
    const std::int16_t dim[] = {4, 4, 3, 2, times, 1, 1, 1};
    for (std::size_t n = 0; n < 8; ++n) put(40 + 2 * n, dim[n]);
    put(70, std::int16_t{2});
    put(72, std::int16_t{8});
    const float pixdim[] = {1, 1, 1, 1, spacing};
    for (std::size_t n = 0; n < 5; ++n) put(76 + 4 * n, pixdim[n]);
    put(108, 352.0f);
    bytes[123] = static_cast<char>(2 | unit);
    bytes.replace(344, 3, "n+1");
    for (int step = 0; step < times; ++step) bytes += text(samples(step));
    write(name, bytes);
  }
  /// Packs a file of the folder as NAME.gz.
  void pack(const std::string& name) const {
    ASSERT_EQ(std::system(("gzip -k '" + (folder() / name).string() + "'").c_str()), 0);
  }
  static void add(Hdf5File& file, const std::string& name, int step) {
    file.add(name, {2, 3, 4}, StoredType::kUint8, samples(step).data());
  }

  [[nodiscard]] std::vector<double> times(const std::string& store) const {
    run_well({"info", store, "--json", "info.json", "-q"});
    const auto found = read_json("info.json");
    return found.contains("times") ? found["times"].get<std::vector<double>>() : std::vector<double>{0};
  }
  /// Expects that the steps of a store have the samples of these steps.
  void expect_steps(const std::string& store, const std::vector<int>& steps) const {
    ASSERT_EQ(times(store).size(), steps.size());
    for (std::size_t n = 0; n < steps.size(); ++n) {
      run_well({"restore", store, "--step", std::to_string(n), "-o", "out.raw", "-q"});
      EXPECT_EQ(read("out.raw"), text(samples(steps[n]))) << store << " step " << n;
    }
    run_well({"verify", store, "-q"});
  }
};

TEST_F(FileSeries, AllTimesOfNifti) {
  write_nifti("a.nii", 4, 800, 16);
  run_well({"store", "a.nii", "-o", "a.adm"});
  expect_steps("a.adm", {0, 1, 2, 3});
  const std::vector<double> found = times("a.adm");
  for (std::size_t n = 0; n < 4; ++n) EXPECT_DOUBLE_EQ(found[n], 0.8 * static_cast<double>(n));
  pack("a.nii");
  run_well({"store", "a.nii.gz", "-o", "b.adm"});
  EXPECT_EQ(read("a.adm"), read("b.adm"));
  run_well({"store", "a.nii", "--time", "2", "-o", "one.adm"});
  expect_steps("one.adm", {2});
  // All commands but store use one time.
  expect_failure({"isosurface", "a.nii", "--isovalue", "9", "-o", "s.ply"}, {"a.nii", "adamas store"});
  run_well({"slice", "a.nii", "--time", "1", "--plane", "z=0.5", "-o", "s.png", "-q"});
  expect_failure({"slice", "a.nii", "--plane", "z=0.5", "-o", "t.png"}, {"a.nii", "--time", "(0 to 3)"});
}

TEST_F(FileSeries, TimesOfNiftiInTheirUnits) {
  struct Case {
    float spacing;
    char unit;
    double expected;
  };
  for (const Case& each : {Case{2.5f, 8, 2.5}, Case{0.1f, 8, 0.1}, Case{40, 24, 4e-5}, Case{3, 0, 3},
                           Case{0, 8, 1}, Case{std::numeric_limits<float>::quiet_NaN(), 8, 1}}) {
    write_nifti("a.nii", 2, each.spacing, each.unit);
    run_well({"store", "a.nii", "-o", "a.adm"});
    EXPECT_EQ(times("a.adm"), (std::vector<double>{0, each.expected}));
  }
}

TEST_F(FileSeries, TimesOfNiftiAreAddedBehind) {
  write_nifti("a.nii", 3, 2, 8);
  run_well({"store", "a.nii", "-o", "a.adm", "--append"});
  const RunResult again = run({"store", "a.nii", "-o", "a.adm", "--append"});
  EXPECT_EQ(
      again.err,
      "adamas: note: a.nii: a time between steps but none of the first: 3 steps, taken to be at 6 to 10, "
      "behind the last one of a.adm at 4\n");
  expect_steps("a.adm", {0, 1, 2, 0, 1, 2});
  EXPECT_EQ(times("a.adm"), (std::vector<double>{0, 2, 4, 6, 8, 10}));
}

TEST_F(FileSeries, NiftiThatIsCutOff) {
  write_nifti("a.nii", 3, 2, 8);
  const std::string bytes = read("a.nii");
  for (const std::size_t left : {std::size_t{100}, std::size_t{353}, bytes.size() - 25, bytes.size() - 1}) {
    write("cut.nii", bytes.substr(0, left));
    expect_failure({"store", "cut.nii", "-o", "a.adm"}, {"cut.nii", "expected"});
  }
  pack("a.nii");
  const std::string packed = read("a.nii.gz");
  for (std::size_t left = 0; left < packed.size(); left += 9) {
    write("cut.nii.gz", packed.substr(0, left));
    expect_failure({"store", "cut.nii.gz", "-o", "a.adm"}, {"cut.nii.gz", "expected"});
  }
}

TEST_F(FileSeries, MembersOfAGroupInNaturalOrder) {
  {
    Hdf5File file(folder() / "a.h5");
    for (const int step : {10, 9, 2}) add(file, "run/step" + std::to_string(step), step % 6);
    add(file, "other", 5);
    const std::vector<std::uint8_t> line(5);
    file.add("run/x", {5}, StoredType::kUint8, line.data());
  }
  run_well({"store", "a.h5", "--array", "run", "-o", "a.adm"});
  expect_steps("a.adm", {2, 3, 4});
  EXPECT_EQ(times("a.adm"), (std::vector<double>{0, 1, 2}));
  run_well({"store", "a.h5", "--array", "run/step9", "-o", "one.adm"});
  expect_steps("one.adm", {3});
  run_well({"store", "a.h5", "--array", "/", "-o", "root.adm"});
  expect_steps("root.adm", {5});
  const RunResult again = run({"store", "a.h5", "--array", "/run/", "-o", "a.adm", "--append"});
  EXPECT_NE(again.err.find("a.h5: no times: 3 steps, taken to be at 3 to 5"), std::string::npos) << again.err;
  EXPECT_EQ(times("a.adm"), (std::vector<double>{0, 1, 2, 3, 4, 5}));
  expect_failure({"store", "a.h5", "-o", "b.adm"}, {"a.h5", "the name of a data set", "'run/step9'"});
  expect_failure({"store", "a.h5", "--array", "none", "-o", "b.adm"}, {"a.h5", "'none'"});
}

TEST_F(FileSeries, MembersWithTimes) {
  const auto make = [this](const std::vector<double>& of_steps) {
    Hdf5File file(folder() / "a.h5");
    for (std::size_t n = 0; n < of_steps.size(); ++n) {
      const std::string name = "run/s" + std::to_string(n);
      add(file, name, static_cast<int>(n));
      file.add_numbers(name, "time", {of_steps[n]});
    }
  };
  make({3, 1.5});
  run_well({"store", "a.h5", "--array", "run", "-o", "a.adm"});
  expect_steps("a.adm", {1, 0});
  EXPECT_EQ(times("a.adm"), (std::vector<double>{1.5, 3}));
  run_well({"info", "a.h5", "--array", "run", "--json", "info.json"});
  const auto known = read_json("info.json");
  EXPECT_EQ(known["kind"], "series");
  EXPECT_EQ(known["steps"], 2);
  EXPECT_EQ(known["times"], (std::vector<double>{1.5, 3}));
  // The first step is the earliest one.
  const auto later = samples(1);
  EXPECT_EQ(known["first_step"]["arrays"][0]["min"], *std::min_element(later.begin(), later.end()));
  EXPECT_EQ(known["first_step"]["arrays"][0]["max"], *std::max_element(later.begin(), later.end()));
  // Slices are in the order of time too.
  run_well({"slice", "a.h5", "--array", "run/s0", "--plane", "z=0", "-o", "s.vtp", "-q"});
  run_well({"slice", "a.h5", "--array", "run", "--plane", "z=0", "-o", "s_%d.vtp", "-q"});
  EXPECT_TRUE(read("s.vtp") == read("s_1.vtp"));
  // The file now has further steps, as when a simulation goes on.
  make({3, 1.5, 4, 4.5});
  const RunResult result = run({"store", "a.h5", "--array", "run", "-o", "a.adm", "--append", "-q"});
  EXPECT_EQ(result.status, 0) << result.err;
  expect_steps("a.adm", {1, 0, 2, 3});
  EXPECT_EQ(times("a.adm"), (std::vector<double>{1.5, 3, 4, 4.5}));
  make({1, 2, 1});
  expect_failure({"store", "a.h5", "--array", "run", "-o", "b.adm"}, {"a.h5", "1 twice", "run/s0", "run/s2"});
  make({1, std::numeric_limits<double>::infinity()});
  expect_failure({"store", "a.h5", "--array", "run", "-o", "b.adm"}, {"a.h5", "finite", "run/s1"});
}

/// Times of only some steps, or of another number of steps, are ignored with a note.
TEST_F(FileSeries, TimesThatDoNotFitAreNotFollowed) {
  std::vector<std::uint8_t> all;
  for (int step = 0; step < 3; ++step) {
    const auto one = samples(step);
    all.insert(all.end(), one.begin(), one.end());
  }
  {
    Hdf5File file(folder() / "a.h5");
    for (int step = 0; step < 3; ++step) add(file, "run/s" + std::to_string(step), step);
    file.add_numbers("run/s1", "time", {7});
    file.add("all", {3, 2, 3, 4}, StoredType::kUint8, all.data());
    file.add_numbers("all", "time", {4, 5});
  }
  const RunResult some = run({"store", "a.h5", "--array", "run", "-o", "a.adm"});
  EXPECT_EQ(
      some.err,
      "adamas: note: a.h5: 1 of 3 data sets in 'run' have a time: steps are taken to be at 0, 1, 2 ...\n");
  expect_steps("a.adm", {0, 1, 2});
  EXPECT_EQ(times("a.adm"), (std::vector<double>{0, 1, 2}));
  const RunResult few = run({"store", "a.h5", "--array", "all", "-o", "b.adm"});
  EXPECT_EQ(few.err,
            "adamas: note: a.h5: 'all' has 2 numbers as its time, of 3 steps: these are taken to be at 0, 1, "
            "2 ...\n");
  expect_steps("b.adm", {0, 1, 2});
}

TEST_F(FileSeries, TheFirstOfFourAxesIsTime) {
  std::vector<std::uint8_t> all;
  for (int step = 0; step < 5; ++step) {
    const auto one = samples(step);
    all.insert(all.end(), one.begin(), one.end());
  }
  for (const std::uint64_t chunk : {0, 2}) {
    Hdf5File(folder() / "a.h5").add("all", {5, 2, 3, 4}, StoredType::kUint8, all.data(), chunk);
    run_well({"store", "a.h5", "-o", "a.adm"});
    expect_steps("a.adm", {0, 1, 2, 3, 4});
    run_well({"store", "a.h5", "--time", "3", "-o", "one.adm"});
    expect_steps("one.adm", {3});
  }
  expect_failure({"store", "a.h5", "--time", "5", "-o", "b.adm"}, {"a.h5: all", "from 0 to 4", "found 5"});
  expect_failure({"slice", "a.h5", "--plane", "z=0", "-o", "s.png"}, {"a.h5: all", "--time (0 to 4)"});
  expect_wrong_usage({"slice", "a.h5", "--step", "1", "--plane", "z=0", "-o", "s.png"},
                     {"a.h5", "--time says"});
  run_well({"slice", "a.h5", "--time", "3", "--plane", "z=0", "-o", "s.vtp", "-q"});
  run_well({"slice", "a.h5", "--plane", "z=0", "-o", "s.pvd", "-q"});
  EXPECT_TRUE(read("s.vtp") == read("s_0003.vtp"));
  {
    Hdf5File file(folder() / "t.h5");
    file.add("all", {5, 2, 3, 4}, StoredType::kUint8, all.data());
    file.add_numbers("all", "time", {0, 0.5, 1, 7, 8});
  }
  run_well({"store", "t.h5", "--array", "all", "-o", "a.adm"});
  EXPECT_EQ(times("a.adm"), (std::vector<double>{0, 0.5, 1, 7, 8}));
}

TEST_F(FileSeries, OtherGridsAndDamageAreToldByName) {
  {
    Hdf5File file(folder() / "a.h5");
    add(file, "run/s0", 0);
    const auto bytes = samples(1);
    file.add("run/s1", {4, 3, 2}, StoredType::kUint8, bytes.data());
    file.add("empty/s0", {2, 3, 4}, StoredType::kUint8, nullptr);
    file.add("flat/s0", {3, 4}, StoredType::kUint8, bytes.data());
  }
  expect_failure({"store", "a.h5", "--array", "run", "-o", "b.adm"},
                 {"a.h5: run/s1", "4 x 3 x 2 uint8", "run/s0", "found 2 x 3 x 4"});
  expect_failure({"store", "a.h5", "--array", "empty", "-o", "b.adm"}, {"a.h5: empty/s0", "without any"});
  expect_failure({"store", "a.h5", "--array", "flat", "-o", "b.adm"}, {"a.h5", "three axes", "'flat'"});
  const std::string bytes = read("a.h5");
  for (const std::size_t left : {std::size_t{0}, std::size_t{90}, bytes.size() / 2}) {
    write("cut.h5", bytes.substr(0, left));
    expect_failure({"store", "cut.h5", "--array", "run", "-o", "b.adm"}, {"cut.h5"});
  }
}

}  // namespace
}  // namespace adamas::test
