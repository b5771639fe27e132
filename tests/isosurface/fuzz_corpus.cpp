#include "tests/fuzz/replay.h"
#include "tests/fuzz/residual_targets.h"

namespace adamas {
namespace {

TEST(FuzzCorpus, ResidualCode) { EXPECT_EQ(fuzz::replay("residual_code", fuzz::residual_code), 4u); }

}  // namespace
}  // namespace adamas
