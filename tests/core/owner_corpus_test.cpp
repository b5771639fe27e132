#include "tests/fuzz/owner_targets.h"
#include "tests/fuzz/replay.h"

namespace adamas {
namespace {

TEST(FuzzCorpus, OwnerKernel) { EXPECT_EQ(fuzz::replay("owner_kernel", fuzz::owner_kernel), 26u); }

}  // namespace
}  // namespace adamas
