// Tests that messages state the cause of an error, not its consequence.

#include <cstdlib>

#include "program.h"

namespace adamas::test {
namespace {

class ToldReasons : public ProgramTest {
 protected:
  ToldReasons() {
    write("v.raw", std::string(512, '\1'));
    run_well({"generate", "buckyball", "--dimensions", "8", "-o", "b.nii.gz", "-q"});
  }
};

/// While an object lives, the environment variable has this value.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    ::setenv(name, value, 1);
  }
  ~Variable() { before_.empty() ? ::unsetenv(name_) : ::setenv(name_, before_.c_str(), 1); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::string before_;
};

TEST_F(ToldReasons, NoFolderForTemporaryFiles) {
  const std::vector<std::string> raw{"store", "v.raw", "--dimensions", "8", "--type", "uint8", "-o", "v.adm"};
  const Variable variable("TMPDIR", "/nowhere");
  const std::string message = "TMPDIR: expected a folder for temporary files, found '/nowhere'";
  expect_failure(raw, {message});
  expect_failure({"info", "b.nii.gz"}, {message});
  auto elsewhere = raw;
  elsewhere.insert(elsewhere.end(), {"--scratch", "."});
  run_well(elsewhere);
}

TEST_F(ToldReasons, ABlankBetweenANumberAndItsUnit) {
  expect_wrong_usage({"reconstruct", "c.vtr", "--fraction-error", "2", "%", "-o", "i.vtp"},
                     {"--fraction-error: expected '2%' without a blank, found '2' and '%'"});
  expect_wrong_usage({"resample", "c.vtr", "--interface-error", "1", "%", "-o", "m.vtu"},
                     {"--interface-error: expected '1%' without a blank"});
  expect_wrong_usage({"isosurface", "b.adm", "--isovalue", "80", "--error", "0.5", "voxels", "-o", "b.ply"},
                     {"--error: expected '0.5voxels' without a blank"});
  // Where a file has the name of the unit there is no such hint.
  write("cells", "");
  EXPECT_EQ(run({"store", "v.raw", "--time", "1", "cells", "-o", "v.adm"}).err.find("without a blank"),
            std::string::npos);
}

TEST_F(ToldReasons, NoFileOfAPattern) {
  expect_failure(
      {"store", "run_%04d.vti", "-o", "r.adm"},
      {"run_%04d.vti: expected files with names such as 'run_0001.vti' in '.', found none among its 2"});
  expect_failure({"resample", "run_*.vti", "--interface-error", "1%", "-o", "m.pvd"},
                 {"run_*.vti: expected files with names such as 'run_*.vti' in '.', found none"});
}

TEST_F(ToldReasons, LevelsOfAStore) {
  run_well({"store", "b.nii.gz", "-o", "b.adm", "-q"});
  run_well({"generate", "buckyball", "--dimensions", "33", "-o", "c.nii", "-q"});
  run_well({"store", "c.nii", "-o", "c.adm", "-q"});
  EXPECT_NE(run_well({"info", "c.adm"}).out.find("all samples to one in 4 along each axis"),
            std::string::npos);
}

}  // namespace
}  // namespace adamas::test
