#include "program.h"

namespace adamas::test {
namespace {

class ReferenceProgram : public ProgramTest {};

TEST_F(ReferenceProgram, BuildsWithoutItSaySoInOneLine) {
#ifdef ADAMAS_REFERENCE_PROGRAM
  GTEST_SKIP() << "this build has adamas-reference";
#endif
  make_scene("sphere", 6);
  expect_failure({"compare", "scene.vtr"}, {"compare: this build is without adamas-reference"});
  expect_failure({"resample", "scene.vtr", "--verify-by", "cgal", "--json", "f.json"},
                 {"--verify-by: this build is without adamas-reference"});
}

}  // namespace
}  // namespace adamas::test
