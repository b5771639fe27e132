#include "tests/fuzz/bounds_targets.h"
#include "tests/fuzz/gradient_targets.h"
#include "tests/fuzz/replay.h"
#include "tests/fuzz/residual_targets.h"
#include "tests/fuzz/sample_targets.h"
#include "tests/fuzz/store_file_targets.h"
#include "tests/fuzz/store_targets.h"
#include "tests/fuzz/time_targets.h"

namespace adamas {

using namespace isosurface;

namespace {

TEST(FuzzCorpus, ResidualCode) { EXPECT_EQ(fuzz::replay("residual_code", fuzz::residual_code), 4u); }

TEST(FuzzCorpus, SampleCodec) { EXPECT_EQ(fuzz::replay("sample_codec", fuzz::sample_codec), 12u); }
TEST(FuzzCorpus, BoundsCodec) { EXPECT_EQ(fuzz::replay("bounds_codec", fuzz::bounds_codec), 7u); }
TEST(FuzzCorpus, GradientCodec) { EXPECT_EQ(fuzz::replay("gradient_codec", fuzz::gradient_codec), 5u); }
TEST(FuzzCorpus, TimeCodec) { EXPECT_EQ(fuzz::replay("time_codec", fuzz::time_codec), 7u); }
TEST(FuzzCorpus, StoreFile) { EXPECT_EQ(fuzz::replay("store_file", fuzz::store_file), 6u); }
TEST(FuzzCorpus, StoreFormat) { EXPECT_EQ(fuzz::replay("store_format", fuzz::store_format), 7u); }

}  // namespace
}  // namespace adamas
