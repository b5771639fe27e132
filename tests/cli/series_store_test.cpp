#include <unistd.h>

#include <chrono>
#include <csignal>
#include <random>

#include "tests/cli/series_stores.h"

namespace adamas::test {
namespace {

TEST_F(SeriesStores, OfSeveralVolumesAndOfAPattern) {
  run_well(store({file(0), file(1), file(2), file(3), file(4)}, "a.adm"));
  run_well(store({"s_%d.raw"}, "b.adm"));
  EXPECT_EQ(read("a.adm"), read("b.adm"));
  for (int step = 0; step < 5; ++step) expect_step("a.adm", step);
  const auto found = info("a.adm");
  EXPECT_EQ(found["steps"], 5);
  EXPECT_EQ(found["times"], (std::vector<double>{0, 1, 2, 3, 4}));
  run_well({"verify", "a.adm", "-q"});
}

TEST_F(SeriesStores, ThereAndBackByPvd) {
  run_well(store({"s_%d.raw"}, "a.adm"));
  run_well({"restore", "a.adm", "-o", "back.pvd", "-q"});
  run_well({"store", "back.pvd", "-o", "b.adm", "-q"});
  for (int step = 0; step < 5; ++step) expect_step("b.adm", step);
  run_well({"restore", "a.adm", "--steps", "1,3", "-o", "some.pvd", "-q"});
  run_well({"store", "some.pvd", "-o", "c.adm", "-q"});
  EXPECT_EQ(info("c.adm")["times"], (std::vector<double>{1, 2, 3}));
}

/// Steps that are restored together begin anywhere, and their number depends on the memory.
TEST_F(SeriesStores, StepsAreRestoredTogetherOrAlone) {
  std::vector<std::string> inputs;
  for (int step = 0; step < 19; ++step) inputs.push_back(file(step % 5));
  run_well(store(inputs, "a.adm"));
  for (const std::string memory : {"256M", "4K", "1"}) {
    run_well(
        {"restore", "a.adm", "--steps", "3,18", "--memory", memory, "-o", "back.pvd", "--overwrite", "-q"});
    for (int step = 3; step < 19; ++step) {
      const std::string name = (step < 10 ? "back_000" : "back_00") + std::to_string(step) + ".vti";
      const std::string bytes = read(name);
      EXPECT_NE(bytes.find(samples(step % 5)), std::string::npos) << name << " with " << memory;
    }
  }
}

TEST_F(SeriesStores, StepsAreAdded) {
  run_well(store({file(0), file(1)}, "a.adm", {"--append"}));
  for (const int step : {2, 3, 4}) run_well(store({file(step)}, "a.adm", {"--append"}));
  for (int step = 0; step < 5; ++step) expect_step("a.adm", step);
  EXPECT_EQ(info("a.adm")["blocks"], 4);
  run_well({"verify", "a.adm", "-q"});
}

TEST_F(SeriesStores, InGroupsOfPages) {
  run_well(store({"s_%d.raw"}, "one.adm"));
  run_well(store({file(0), file(1)}, "a.adm", {"--group-pages", "8", "--append"}));
  for (const int step : {2, 3, 4}) run_well(store({file(step)}, "a.adm", {"--append"}));
  for (int step = 0; step < 5; ++step) expect_step("a.adm", step);
  EXPECT_EQ(info("a.adm")["group_pages"], 8);
  EXPECT_EQ(info("one.adm")["group_pages"], 1);
  run_well({"verify", "a.adm", "-q"});
  for (const std::string name : {"one", "a"}) {
    run_well({"isosurface", name + ".adm", "--step", "3", "--isovalue", "30", "-o", name + ".ply", "-q"});
    run_well({"play", name + ".adm", "--isovalue", "30", "--json", name + ".json", "-q"});
  }
  EXPECT_EQ(read("a.ply"), read("one.ply"));
  const auto played = read_json("a.json"), expected = read_json("one.json");
  for (std::size_t n = 0; n < 5; ++n)
    EXPECT_EQ(played["frames"][n]["triangles"], expected["frames"][n]["triangles"]) << n;
}

/// When a simulation makes its list longer, only the later steps are added.
TEST_F(SeriesStores, LaterStepsOfAListAreAdded) {
  run_well(store({"s_%d.raw"}, "all.adm"));
  run_well({"restore", "all.adm", "--steps", "0,2", "-o", "back.pvd", "-q"});
  run_well({"store", "back.pvd", "-o", "a.adm", "-q"});
  run_well({"restore", "all.adm", "-o", "back.pvd", "--overwrite", "-q"});
  const RunResult result = run({"store", "back.pvd", "-o", "a.adm", "--append", "-q"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(info("a.adm")["times"], (std::vector<double>{0, 1, 2, 3, 4}));
  for (int step = 0; step < 5; ++step) expect_step("a.adm", step);
}

TEST_F(SeriesStores, SurfacesOfSteps) {
  run_well(store({"s_%d.raw"}, "a.adm"));
  run_well(store({file(3)}, "one.adm"));
  run_well({"isosurface", "a.adm", "--step", "3", "--isovalue", "30", "-o", "a.ply", "-q"});
  run_well({"isosurface", "one.adm", "--isovalue", "30", "-o", "b.ply", "-q"});
  EXPECT_EQ(read("a.ply"), read("b.ply"));
}

TEST_F(SeriesStores, SlicesOfSteps) {
  run_well(store({"s_%d.raw"}, "a.adm"));
  run_well(store({file(3)}, "one.adm"));
  run_well({"slice", "a.adm", "--step", "3", "--origin", "4,4,4", "--normal", "0,0,1", "-o", "a.vtp", "-q"});
  expect_wrong_usage({"slice", "a.adm", "--step", "5", "--plane", "z=4", "-o", "c.png"},
                     {"--step", "5 steps"});
  const RunResult result = run({"slice", "a.adm", "--plane", "z=4", "-o", "c.png"});
  run_well({"slice", "one.adm", "--origin", "4,4,4", "--normal", "0,0,1", "-o", "b.vtp", "-q"});
  EXPECT_TRUE(read("a.vtp") == read("b.vtp"));
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.err.find("the first of 5 steps"), std::string::npos) << result.err;
}

TEST_F(SeriesStores, WrongUsage) {
  run_well(store({"s_%d.raw"}, "a.adm"));
  expect_wrong_usage({"restore", "a.adm", "--step", "5", "-o", "r.raw"}, {"--step", "5 steps"});
  expect_wrong_usage({"restore", "a.adm", "--steps", "3,1", "-o", "r.pvd"}, {"--steps", "3,1"});
  expect_wrong_usage({"restore", "a.adm", "--steps", "1,3", "-o", "r.raw"}, {"--steps", "r.raw"});
  expect_wrong_usage(store({"s_%d.raw"}, "b.adm", {"--block-steps", "1000"}), {"--block-steps", "256"});
  for (const std::string pages : {"0", "3", "1024", "8x"})
    expect_wrong_usage(store({"s_%d.raw"}, "b.adm", {"--group-pages", pages}), {"--group-pages", pages});
  write("short.raw", "123");
  expect_failure(store({file(0), "short.raw"}, "b.adm"), {"short.raw"});
  expect_failure(store({file(0), "missing.raw"}, "b.adm"), {"missing.raw"});
}

TEST_F(SeriesStores, GradientsAreSmoothedAlongTimeUnlessToldOtherwise) {
  run_well(store({"s_%d.raw"}, "time.adm", {"--gradients"}));
  run_well(store({"s_%d.raw"}, "space.adm", {"--gradients", "--no-time-smoothing"}));
  EXPECT_NE(read("time.adm"), read("space.adm"));
  run_well({"verify", "time.adm", "-q"});
  expect_step("time.adm", 3);
  // With one step, or blocks of one step, there is nothing to smooth along time.
  run_well(store({file(2)}, "a.adm", {"--gradients"}));
  run_well(store({file(2)}, "b.adm", {"--gradients", "--no-time-smoothing"}));
  EXPECT_EQ(read("a.adm"), read("b.adm"));
  run_well(store({"s_%d.raw"}, "a.adm", {"--gradients", "--block-steps", "1"}));
  run_well(store({"s_%d.raw"}, "b.adm", {"--gradients", "--block-steps", "1", "--no-time-smoothing"}));
  EXPECT_EQ(read("a.adm"), read("b.adm"));
  expect_wrong_usage(store({file(0)}, "x.adm", {"--no-time-smoothing"}),
                     {"--no-time-smoothing", "--gradients"});
  expect_wrong_usage(
      store({file(0)}, "x.adm", {"--gradients", "--smoothing", "first", "--no-time-smoothing"}),
      {"--no-time-smoothing", "both phases"});
}

TEST_F(SeriesStores, StepsOnAnotherGridAreRefused) {
  run_well(store({file(0)}, "a.adm"));
  run_well({"restore", "a.adm", "-o", "a.vti", "-q"});
  run_well({"generate", "buckyball", "--dimensions", "8", "-o", "b.vti", "-q"});
  expect_failure({"store", "a.vti", "b.vti", "-o", "c.adm"}, {"b.vti", "9 x 9 x 9 uint8", "8 x 8 x 8"});
  const std::string before = read("a.adm");
  expect_failure({"store", "b.vti", "-o", "a.adm", "--append"}, {"b.vti", "9 x 9 x 9 uint8", "8 x 8 x 8"});
  EXPECT_EQ(read("a.adm"), before);
}

TEST_F(SeriesStores, ListsThatAreNone) {
  write("a.pvd", "<?xml version=\"1.0\"?><VTKFile type=\"Collection\"><Collection/></VTKFile>");
  expect_failure({"store", "a.pvd", "-o", "a.adm"}, {"a.pvd", "DataSet"});
  write("b.pvd", "<?xml version=\"1.0\"?><VTKFile type=\"ImageData\"/>");
  expect_failure({"store", "b.pvd", "-o", "a.adm"}, {"b.pvd", "Collection"});
  write("c.pvd",
        "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"1\" file=\"x.vti\"/>"
        "<DataSet timestep=\"1\" file=\"y.vti\"/></Collection></VTKFile>");
  expect_failure({"store", "c.pvd", "-o", "a.adm"}, {"c.pvd", "x.vti", "y.vti"});
  write("d.pvd",
        "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"now\" "
        "file=\"x.vti\"/></Collection></VTKFile>");
  expect_failure({"store", "d.pvd", "-o", "a.adm"}, {"d.pvd", "now"});
  write("e.pvd",
        "<VTKFile type=\"Collection\"><Collection><DataSet file=\"none.vti\"/></Collection></VTKFile>");
  expect_failure({"store", "e.pvd", "-o", "a.adm"}, {"none.vti"});
}

TEST_F(SeriesStores, ADataSetWithoutTimeAmongOthersIsRefused) {
  write("f.pvd",
        "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"1\" file=\"x.vti\"/>"
        "<DataSet file=\"y.vti\"/></Collection></VTKFile>");
  expect_failure({"store", "f.pvd", "-o", "a.adm"}, {"f.pvd", "timestep", "y.vti"});
}

/// Where a file has several arrays, a note says which one is taken, once for all steps.
TEST_F(SeriesStores, TheArrayThatIsTakenIsTold) {
  run_well({"generate", "mixing", "--dimensions", "12", "--steps", "3", "-o", "m.pvd", "-q"});
  const RunResult first = run({"store", "m.pvd", "-o", "a.adm", "--json", "j.json"});
  EXPECT_EQ(first.err,
            "adamas: note: m_0000.vti: the array 'entropy' is taken, not 'density': --array names another\n");
  EXPECT_EQ(read_json("j.json")["array"], "entropy");
  run_well({"store", "m.pvd", "--array", "density", "-o", "b.adm", "--json", "j.json"});
  EXPECT_EQ(read_json("j.json")["array"], "density");
  EXPECT_NE(read("a.adm"), read("b.adm"));
  run_well(store({file(0)}, "c.adm", {"--json", "j.json"}));
  EXPECT_TRUE(read_json("j.json")["array"].is_null());
}

TEST_F(SeriesStores, ValuesOnCellsAreToldAsSuch) {
  for (const std::string name : {"s.vtr", "s.vti"}) {
    run_well({"generate", "scene", "sphere", "--dimensions", "6", "-o", name, "-q"});
    expect_failure({"store", name, "-o", "a.adm"}, {name, "values on cells alone", "Volume Fraction"});
  }
}

/// The message says which part of the grid differs.
TEST_F(SeriesStores, WhatDiffersOfTheGridIsTold) {
  const auto make = [this](const std::string& output, const std::vector<std::string>& more) {
    run_well(store({file(0)}, "t.adm", more));
    run_well({"restore", "t.adm", "-o", output, "-q"});
  };
  make("a.vti", {});
  make("far.vti", {"--first-sample", "1,2,3"});
  make("wide.vti", {"--spacing", "1,1,2"});
  expect_failure({"store", "a.vti", "far.vti", "-o", "x.adm"},
                 {"far.vti", "place of a.vti, (0, 0, 0), found (1, 2, 3)"});
  expect_failure({"store", "a.vti", "wide.vti", "-o", "x.adm"},
                 {"wide.vti", "spacing of a.vti, (1, 1, 1), found (1, 1, 2)"});
}

/// The program is killed again and again while it adds steps: the store has all steps that were finished, and
/// no others.
TEST_F(SeriesStores, AreWholeWhereverTheProgramIsKilled) {
  const auto start = std::chrono::steady_clock::now();
  run_well(store({file(0)}, "a.adm"));
  const std::chrono::duration<double, std::micro> taken = std::chrono::steady_clock::now() - start;
  std::mt19937 random(7);
  auto longest = static_cast<unsigned>(taken.count());  // duration of the longest run so far
  std::size_t steps = 1, killed = 0;
  for (int time = 0; time < 60; ++time) {
    RunOptions options;
    options.interrupt_when = [] { return true; };
    options.act = [&](pid_t program) {
      usleep(random() % longest);
      kill(program, SIGKILL);
    };
    const RunResult result =
        run(store({file(static_cast<int>(steps % 5))}, "a.adm", {"--append", "-q"}), options);
    const std::size_t found = info("a.adm")["steps"];
    ASSERT_TRUE(found == steps || found == steps + 1) << time;
    if (result.status == 1000 + SIGKILL) {
      ++killed;
      longest += longest / 50;
    } else {
      ASSERT_EQ(result.status, 0) << result.err;
      ASSERT_EQ(found, steps + 1) << time;
      longest = std::max(longest - longest / 25, 1000u);
    }
    steps = found;
    if (time % 20 == 19) run_well({"verify", "a.adm", "-q"});
  }
  EXPECT_GT(killed, 25u);
  EXPECT_GT(steps, 10u);
  for (std::size_t step = 0; step < steps; step += 9) {
    run_well({"restore", "a.adm", "--step", std::to_string(step), "-o", "out.raw", "-q"});
    EXPECT_EQ(read("out.raw"), samples(static_cast<int>(step % 5))) << step;
  }
}

}  // namespace
}  // namespace adamas::test
