// Tests `adamas view` without a window: frames of a flight.

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <set>

#include "store_test.h"

namespace adamas::test {

namespace {

class ViewCommand : public StoreTest {
 protected:
  void SetUp() override {
    make_ball();
    make_store();
    const RunResult tried = view({"--camera-path", "orbit:1", "--json", "tried.json"});
    if (tried.err.find("expected EGL") != std::string::npos ||
        tried.err.find("expected OpenGL 4.5") != std::string::npos)
      GTEST_SKIP() << tried.err;
    ASSERT_EQ(tried.status, 0) << tried.err;
  }
  RunResult view(const std::vector<std::string>& more) {
    std::vector<std::string> all{"view", "b.adm", "--isovalue", "80.5", "--offscreen", "--size", "160,120"};
    all.insert(all.end(), more.begin(), more.end());
    return run(all);
  }
};

TEST_F(ViewCommand, WritesAPictureAndFiguresForEachFrame) {
  const RunResult result = view({"--camera-path", "orbit:3", "--frames", "frames", "--json", "f.json"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("drawn by"), std::string::npos);
  const auto figures = read_json("f.json");
  EXPECT_NE(figures["drawn_by"].get<std::string>().find("EGL"), std::string::npos);
  ASSERT_EQ(figures["frames"].size(), 3u);
  std::set<std::string> pictures;
  for (const char* name : {"frames/frame0001.png", "frames/frame0002.png", "frames/frame0003.png"}) {
    const std::string bytes = read(name);
    EXPECT_EQ(bytes.substr(1, 3), "PNG");
    pictures.insert(bytes);
  }
  EXPECT_EQ(pictures.size(), 3u) << "the same from other places";
  for (const auto& frame : figures["frames"]) {
    EXPECT_GT(frame["triangles"], 100);
    EXPECT_LE(frame["largest_error_pixels"], 1);
    EXPECT_GE(frame["update_seconds"], 0);
  }
  EXPECT_GT(figures["frames"][0]["splits"], 0);
  EXPECT_EQ(figures["frames"][0]["merges"], 0);
  // Existing frames are replaced only when that is asked for.
  EXPECT_EQ(view({"--camera-path", "orbit:3", "--frames", "frames"}).status, 1);
  ASSERT_EQ(view({"--camera-path", "orbit:1", "--frames", "frames", "--overwrite"}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder() / "frames/frame0002.png"));
}

TEST_F(ViewCommand, ComesBackToTheSamePicture) {
  write("path.txt",
        "100 20 30  19.5 19.5 19.5  0 0 1\n"
        "25 -15 18  19.5 19.5 19.5  0 0 1\n"
        "100 20 30  19.5 19.5 19.5  0 0 1\n");
  ASSERT_EQ(view({"--camera-path", "path.txt", "--frames", "frames", "--json", "f.json"}).status, 0);
  const auto frames = read_json("f.json")["frames"];
  EXPECT_GT(frames[1]["triangles"], frames[0]["triangles"]) << "nearer";
  EXPECT_GT(frames[2]["merges"], 0);
  EXPECT_EQ(frames[2]["triangles"], frames[0]["triangles"]);
  EXPECT_EQ(read("frames/frame0003.png"), read("frames/frame0001.png"));
}

TEST_F(ViewCommand, KeepsToItsLimits) {
  ASSERT_EQ(
      view({"--camera-path", "orbit:2", "--max-triangles", "500", "--pixels", "0.1", "--json", "f.json"})
          .status,
      0);
  const auto figures = read_json("f.json");
  for (const auto& frame : figures["frames"]) {
    EXPECT_LE(frame["triangles"], 500);
    EXPECT_GT(frame["triangles"], 450);
    EXPECT_GT(frame["largest_error_pixels"], 0.1);
  }
  ASSERT_EQ(
      view({"--camera-path", "orbit:2", "--pixels", "20", "--json", "g.json", "--shading", "sphere"}).status,
      0);
  EXPECT_LE(read_json("g.json")["frames"][0]["largest_error_pixels"], 20);
}

TEST_F(ViewCommand, WaitsForPagesOrTellsHowManyAreMissing) {
  ASSERT_EQ(view({"--camera-path", "orbit:3", "--frames", "frames", "--json", "f.json"}).status, 0);
  const auto waiting = read_json("f.json")["frames"];
  for (const auto& frame : waiting) {
    EXPECT_EQ(frame["pages_missing"], 0);
    EXPECT_EQ(frame["pages_lost"], 0);
  }
  ASSERT_EQ(view({"--camera-path", "orbit:3", "--paging", "async", "--json", "g.json"}).status, 0);
  const auto frames = read_json("g.json")["frames"];
  ASSERT_EQ(frames.size(), 3u);
  for (std::size_t n = 0; n < frames.size(); ++n) {
    EXPECT_EQ(frames[n]["pages_lost"], 0);
    if (frames[n]["pages_missing"] == 0) {
      EXPECT_EQ(frames[n]["triangles"], waiting[n]["triangles"]);
      EXPECT_EQ(frames[n]["largest_error_pixels"], waiting[n]["largest_error_pixels"]);
    }
  }
  // A picture shows the final mesh, however short the time of a frame is.
  ASSERT_EQ(view({"--camera-path", "orbit:3", "--frames", "short", "--frame-time", "0.001"}).status, 0);
  for (const char* name : {"frame0001.png", "frame0002.png", "frame0003.png"})
    EXPECT_EQ(read(std::string("short/") + name), read(std::string("frames/") + name));
}

TEST_F(ViewCommand, ShowsTheStepThatIsAskedFor) {
  std::string samples = read("ball.raw");
  for (std::size_t n = 0; n < samples.size(); ++n) samples[n] = n % 40 < 20 ? samples[n] : '\0';
  write("half.raw", samples);
  const std::vector<std::string> raw{"--dimensions", "40", "--type", "uint8", "-o"};
  const auto store = [&](std::vector<std::string> all, const std::string& output) {
    all.insert(all.begin(), "store");
    all.insert(all.end(), raw.begin(), raw.end());
    all.push_back(output);
    run_well(all);
  };
  store({"ball.raw", "half.raw"}, "b.adm");
  ASSERT_EQ(view({"--camera-path", "orbit:1", "--step", "1", "--frames", "second"}).status, 0);
  const RunResult first = view({"--camera-path", "orbit:1", "--frames", "first"});
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_NE(first.err.find("b.adm: the first of 2 steps"), std::string::npos) << first.err;
  const RunResult none = view({"--camera-path", "orbit:1", "--step", "2", "--json", "f.json"});
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("b.adm: expected a step below 2, found 2"), std::string::npos) << none.err;
  store({"half.raw"}, "b.adm");
  ASSERT_EQ(view({"--camera-path", "orbit:1", "--frames", "half"}).status, 0);
  EXPECT_TRUE(read("second/frame0001.png") == read("half/frame0001.png"));
  EXPECT_FALSE(read("first/frame0001.png") == read("half/frame0001.png"));
}

TEST_F(ViewCommand, ShowsAFrameOfEachStepWhileTheCameraMoves) {
  make_series(5, 4);
  write("path.txt",
        "100 20 30  19.5 19.5 19.5  0 0 1\n"
        "25 -65 18  19.5 19.5 19.5  0 0 1\n");
  const RunResult result =
      view({"--steps", "1,3", "--camera-path", "path.txt", "--frames", "frames", "--json", "f.json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto frames = read_json("f.json")["frames"];
  ASSERT_EQ(frames.size(), 3u);
  for (std::size_t n = 0; n < 3; ++n) EXPECT_EQ(frames[n]["step"], n + 1);
  // The first and the last frame are those of their steps alone, at the ends of the path.
  ASSERT_EQ(view({"--step", "1", "--camera-path", "path.txt", "--frames", "one"}).status, 0);
  ASSERT_EQ(view({"--step", "3", "--camera-path", "path.txt", "--frames", "three"}).status, 0);
  EXPECT_TRUE(read("frames/frame0001.png") == read("one/frame0001.png"));
  EXPECT_TRUE(read("frames/frame0003.png") == read("three/frame0002.png"));
  EXPECT_FALSE(read("frames/frame0002.png") == read("frames/frame0003.png"));
  // Without a path the camera does not move.
  ASSERT_EQ(view({"--steps", "0,4", "--frames", "still"}).status, 0);
  ASSERT_EQ(view({"--step", "4", "--camera-path", "orbit:1", "--frames", "four"}).status, 0);
  EXPECT_TRUE(read("still/frame0005.png") == read("four/frame0001.png"));
  // The bookmarks of a state are such a path, too. The state's step is shown unless another one is given.
  const auto viewpoint = [](const char* eye) {
    return fmt::format(
        R"({{"eye": [{}], "target": [19.5, 19.5, 19.5], "up": [0, 0, 1], "angle": 0.52, "height": 0, "near": 1}})",
        eye);
  };
  const std::string near = viewpoint("100, 20, 30"), far = viewpoint("25, -65, 18");
  write(
      "state.json",
      fmt::format(
          R"({{"viewpoint": {0}, "camera": "fly", "shading": "lit", "colour_map": "grey", "edges": false, "axes": true,
                "colour_bar": true, "box": true, "leaves_out_hidden": false, "pixels": 1, "max_triangles": 500000,
                "cut": {{"on": false, "origin": [0, 0, 0], "normal": [1, 0, 0], "cuts_away": true, "section": true}},
                "bookmarks": [{{"name": "a", "viewpoint": {1}}}, {{"name": "b", "viewpoint": {0}}}],
                "documents": [{{"surfaces": [], "hidden": [], "field": "", "step": 3}}]}})",
          far, near));
  const std::vector<std::string> state{"--state", "state.json", "--frames", "marks", "--overwrite"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), state.begin(), state.end());
    const RunResult drawn = view(more);
    EXPECT_EQ(drawn.status, 0) << drawn.err;
  };
  with({"--camera-path", "bookmarks", "--steps", "1,3"});
  const std::string third = read("marks/frame0003.png");
  EXPECT_FALSE(read("marks/frame0001.png") == third);
  with({});
  EXPECT_TRUE(read("marks/frame0001.png") == third);
  with({"--step", "1"});
  EXPECT_FALSE(read("marks/frame0001.png") == third);
  const auto refused = [&](const std::vector<std::string>& more, const char* message) {
    const RunResult other = view(more);
    EXPECT_EQ(other.status, 2);
    EXPECT_NE(other.err.find(message), std::string::npos) << other.err;
  };
  refused({"--steps", "3,5", "--json", "g.json"}, "--steps: expected two of the 5 steps of the series");
  refused({"--steps", "3,1", "--json", "g.json"}, "from 0 on, A,B with A up to B, found '3,1'");
  refused({"--steps", "1,3", "--step", "2", "--json", "g.json"}, "expected no --step beside it");
  refused({"--frame-rate", "5", "--json", "g.json"}, "--frame-rate: expected a --film");
  refused({"--film", "film.png"}, "--film");
  refused({"--camera-path", "bookmarks", "--json", "g.json"}, "expected a --state with bookmarks");
  const RunResult film = view({"--steps", "0,4", "--film", "film.gif", "--frame-rate", "5"});
  if (film.err.find("expected the program ffmpeg") == std::string::npos) {
    EXPECT_EQ(film.status, 0) << film.err;
    EXPECT_EQ(read("film.gif").substr(0, 4), "GIF8");
  }
}

TEST_F(ViewCommand, ShowsSeveralSurfacesColoursAndStates) {
  const auto picture = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"--camera-path", "orbit:1", "--frames", "frames",
                                 "--overwrite",   "--json",  "f.json"};
    all.insert(all.end(), more.begin(), more.end());
    const RunResult result = view(all);
    EXPECT_EQ(result.status, 0) << result.err;
    return read("frames/frame0001.png");
  };
  std::set<std::string> pictures{picture({})};
  const auto triangles = read_json("f.json")["frames"][0]["triangles"].get<int>();
  EXPECT_TRUE(pictures.insert(picture({"--isovalue", "40", "--opacity", "1", "--opacity", "0.4"})).second);
  EXPECT_GT(read_json("f.json")["frames"][0]["triangles"], triangles);
  EXPECT_TRUE(
      pictures.insert(picture({"--colour-by", "b.adm", "--range", "0,100", "--field", "b.adm"})).second);
  EXPECT_TRUE(pictures.insert(picture({"--plane", "x=19"})).second);
  EXPECT_TRUE(pictures.insert(picture({"--plane", "x=19", "--no-section"})).second);
  EXPECT_TRUE(pictures.insert(picture({"--edges"})).second);
  EXPECT_TRUE(pictures.insert(picture({"--plain"})).second);
  EXPECT_TRUE(pictures.insert(picture({"--shading", "sphere"})).second);
  write("state.json", "{}");
  EXPECT_NE(view({"--state", "state.json", "--json", "f.json"}).err.find("state.json: expected 'viewpoint'"),
            std::string::npos);
}

TEST_F(ViewCommand, LeavesOutWhatIsHiddenFromWhereTheMeshIsFor) {
  ASSERT_EQ(run({"generate", "buckyball", "--dimensions", "64", "-o", "c.vti"}).status, 0);
  ASSERT_EQ(run({"store", "c.vti", "-o", "c.adm"}).status, 0);
  const auto frame = [&](const std::vector<std::string>& more) {
    // Two balls that overlap are seen from the front and from behind.
    std::vector<std::string> all{"view",        "c.adm",         "--isovalue",    "8",
                                 "--pixels",    "0.5",           "--size",        "400,300",
                                 "--json",      "f.json",        "--culled-from", "32,-90,32,32,32,32,0,0,1",
                                 "--offscreen", "--camera-path", "orbit:2"};
    all.insert(all.end(), more.begin(), more.end());
    const RunResult result = run(all);
    EXPECT_EQ(result.status, 0) << result.err;
    const auto frames = read_json("f.json")["frames"];
    EXPECT_EQ(frames[0]["triangles"], frames[1]["triangles"]) << "the mesh is of one view";
    return frames[1];
  };
  const auto all = frame({}), some = frame({"--occlusion"});
  EXPECT_EQ(all["occluded_diamonds"], 0);
  EXPECT_GT(some["occluded_diamonds"], 0);
  EXPECT_LT(some["triangles"], all["triangles"]);
}

TEST_F(ViewCommand, ShowsMeshesWithTheirFields) {
  ASSERT_EQ(run({"generate", "scene", "sphere", "--dimensions", "12,12,12", "-o", "s.vtr"}).status, 0);
  ASSERT_EQ(run({"resample", "s.vtr", "--interface-error", "3%", "-o", "s.vtu", "--save", "s.h5",
                 "--interfaces-out", "s.vtp"})
                .status,
            0);
  const auto picture = [&](const std::string& file, const std::vector<std::string>& more) {
    std::vector<std::string> all{"view",          file,      "--offscreen", "--size", "160,120",
                                 "--camera-path", "orbit:1", "--frames",    "frames", "--overwrite"};
    all.insert(all.end(), more.begin(), more.end());
    const RunResult result = run(all);
    EXPECT_EQ(result.status, 0) << result.err;
    return read("frames/frame0001.png");
  };
  const std::string plain = picture("s.vtu", {});
  EXPECT_EQ(plain, picture("s.h5", {})) << "the whole mesh is the one that was written";
  EXPECT_NE(plain, picture("s.vtu", {"--field", "smooth", "--plane", "x=0.5"}));
  EXPECT_NE(plain, picture("s.vtu", {"--hide", "inside", "--hide", "outside"}));
  EXPECT_NE(plain, picture("b.adm", {"--isovalue", "80"}));
  picture("s.vtp", {});
  const auto failure = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"view", "s.vtu", "--offscreen", "--json", "f.json"};
    all.insert(all.end(), more.begin(), more.end());
    const RunResult result = run(all);
    EXPECT_EQ(result.status, 1);
    return result.err;
  };
  EXPECT_NE(failure({"--field", "none"}).find("--field: expected one of"), std::string::npos);
  EXPECT_NE(failure({"--hide", "none"}).find("--hide: expected one of"), std::string::npos);
}

TEST_F(ViewCommand, NeedsADisplayForItsWindow) {
  for (const char* variable : {"DISPLAY", "WAYLAND_DISPLAY"}) unsetenv(variable);
  const RunResult result = run({"view", "b.adm"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("view: expected a display for a window, found none"), std::string::npos)
      << result.err;
}

TEST_F(ViewCommand, TellsWhatIsWrong) {
  const auto expect = [this](const std::vector<std::string>& options, int status, const std::string& part) {
    const RunResult result = run(options);
    EXPECT_EQ(result.status, status);
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
  };
  const std::vector<std::string> good{"view",        "b.adm",  "--isovalue", "80.5",
                                      "--offscreen", "--json", "f.json"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = good;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  expect({"view", "b.adm", "--isovalue", "80.5", "--json", "f.json"}, 2, "expected --offscreen");
  expect({"view", "b.adm", "--isovalue", "80.5", "--offscreen"}, 2, "expected --frames, --film or --json");
  expect({"view", "b.adm", "--offscreen", "--steps", "0,1", "--json", "f.json"}, 2,
         "--steps: expected a stored series, found none");
  expect(with({"--size", "4,4"}), 2, "from 16 to 8192");
  expect(with({"--pixels", "0"}), 2, "--pixels");
  expect(with({"--frame-time", "-1"}), 2, "--frame-time: expected milliseconds from 0");
  expect(with({"--paging", "perhaps"}), 2, "--paging");
  expect(with({"--opacity", "2"}), 2, "--opacity: expected a number above 0");
  expect(with({"--opacity", "1", "--opacity", "1"}), 2, "--opacity: expected one for each --isovalue");
  expect(with({"--range", "3,1"}), 2, "--range: expected a < b");
  expect(with({"--origin", "0,0,0"}), 2, "expected both --origin and --normal");
  expect(with({"--colour-by", "none.adm"}), 1, "none.adm: expected a store");
  expect({"view", "b.adm", "--camera-path", "orbit:3"}, 2, "--camera-path: expected --offscreen as well");
  expect(with({"--camera-path", "none.txt"}), 1, "none.txt: expected a file of viewpoints or orbit:N");
  expect(with({"--camera-path", "orbit:0"}), 1, "expected a number of frames");
  expect({"view", "ball.raw", "--isovalue", "80.5", "--offscreen", "--json", "f.json"}, 1,
         "ball.raw: expected a store");
  expect({"view", "none.adm", "--isovalue", "80.5", "--offscreen", "--json", "f.json"}, 1,
         "none.adm: expected a store");
}

}  // namespace

}  // namespace adamas::test
