#include "tests/fuzz/cli_targets.h"
#include "tests/fuzz/replay.h"

namespace adamas {
namespace {

TEST(FuzzCorpus, ConfigFile) { EXPECT_EQ(fuzz::replay("config_file", fuzz::config_file), 2u); }

}  // namespace
}  // namespace adamas
