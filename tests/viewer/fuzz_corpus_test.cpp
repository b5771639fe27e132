#include <gtest/gtest.h>

#include "tests/fuzz/replay.h"
#include "tests/fuzz/viewer_targets.h"

namespace adamas {
namespace {

TEST(FuzzCorpus, ViewText) { EXPECT_EQ(fuzz::replay("view_text", fuzz::view_text), 3u); }

}  // namespace
}  // namespace adamas
