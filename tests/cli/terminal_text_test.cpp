// Tests that names and contents of files reach a terminal as text, never as commands to it. Data outputs have
// them unchanged.

#include <algorithm>

#include "program.h"

namespace adamas::test {

namespace {

class TerminalText : public ProgramTest {
 protected:
  /// Expects nothing but text and ends of lines.
  static void expect_harmless(const std::string& text) {
    EXPECT_TRUE(std::all_of(text.begin(), text.end(), [](char c) {
      return c == '\n' || (static_cast<unsigned char>(c) >= 0x20 && c != 0x7f);
    })) << text;
    EXPECT_EQ(text.find("\u009b"), std::string::npos) << text;
    EXPECT_EQ(text.find("\u202e"), std::string::npos) << text;
  }
  RunResult run_harmless(const std::vector<std::string>& arguments, int status) const {
    RunResult result = run(arguments);
    EXPECT_EQ(result.status, status) << result.err;
    expect_harmless(result.out);
    expect_harmless(result.err);
    return result;
  }
  /// Writes labels with an array of this name. Legacy VTK files write special characters of names as numbers.
  void write_labels(const std::string& name, const std::string& array) const {
    std::string text =
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 5 5 5\n"
        "ORIGIN 0 0 0\nSPACING 1 1 1\nCELL_DATA 64\nSCALARS " +
        array + " float\nLOOKUP_TABLE default\n";
    for (int i = 0; i < 64; ++i) text += std::to_string(i % 7) + "\n";
    std::string labels;
    for (int i = 0; i < 64; ++i) labels += std::to_string(i / 32) + "\n";
    write(name, text + "SCALARS m int\nLOOKUP_TABLE default\n" + labels);
  }
};

TEST_F(TerminalText, NamesOfFiles) {
  for (const std::string name : {"a\x1b[31m", "b\x07\x7f", "c\u009b2J", "d\u202egnp", "e\xff", "f\ng"}) {
    const std::string shown = name == "f\ng" ? "f\\x0ag" : name.substr(0, 1) + "\\";
    const RunResult missing = run_harmless({"info", name + ".vti"}, 1);
    ASSERT_EQ(missing.err_lines().size(), 1u);
    EXPECT_NE(missing.err.find(shown), std::string::npos) << missing.err;
    write_labels(name + ".vtk", "p");
    const RunResult found = run_harmless({"info", name + ".vtk", "--labels", "m", "--verbose"}, 0);
    EXPECT_NE(found.out.find(shown), std::string::npos) << found.out;
    run_harmless({"resample", name + ".vtk", "-o", name + ".xyz"}, 2);
    run_harmless({"info", "--" + name}, 2);
    run_harmless({name}, 2);
  }
  write_labels("Grüße 世界.vtk", "p");
  EXPECT_NE(run_harmless({"info", "Grüße 世界.vtk", "--labels", "m"}, 0).out.find("Grüße 世界.vtk"),
            std::string::npos);
}

TEST_F(TerminalText, WhatFilesHold) {
  write_labels("a.vtk", "p%1b]0;title%07%c2%9b");
  // The name can be given as it is shown, and is written so into files that do not allow such characters.
  const std::string name = "p\\x1b]0;title\\x07\\u009b";
  const RunResult info = run_harmless({"info", "a.vtk", "--labels", "m", "--json", "i.json"}, 0);
  EXPECT_NE(info.out.find(name), std::string::npos) << info.out;
  EXPECT_EQ(read_json("i.json")["fields"][0]["name"], name);
  run_harmless({"slice", "a.vtk", "--labels", "m", "--plane", "x=1.5", "--field", "none", "-o", "s.png"}, 1);
  run_harmless({"slice", "a.vtk", "--labels", "m", "--plane", "x=1.5", "--field", name, "-o", "s.png"}, 0);
  // A table of values is data, and is printed as it is written into a file.
  run_well({"resample", "a.vtk", "--labels", "m", "--interface-error", "10%", "-o", "m.vtu"});
  const RunResult values = run_well({"probe", "m.vtu", "--point", "1,1,1"});
  run_well({"probe", "m.vtu", "--point", "1,1,1", "-o", "p.csv"});
  EXPECT_EQ(values.out, read("p.csv"));
}

}  // namespace

}  // namespace adamas::test
