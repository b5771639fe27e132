#include "tests/fuzz/replay.h"
#include "tests/fuzz/targets.h"

namespace adamas {

using namespace interfaces;
using namespace io;

namespace {

TEST(FuzzCorpus, NetworkPly) { EXPECT_EQ(fuzz::replay("network_ply", fuzz::network_ply), 1u); }
TEST(FuzzCorpus, SurfacePly) { EXPECT_EQ(fuzz::replay("surface_ply", fuzz::surface_ply), 2u); }
TEST(FuzzCorpus, NetworkText) { EXPECT_EQ(fuzz::replay("network_text", fuzz::network_text), 4u); }
TEST(FuzzCorpus, RegionNames) { EXPECT_EQ(fuzz::replay("region_names", fuzz::region_names), 1u); }
TEST(FuzzCorpus, NrrdHeader) { EXPECT_EQ(fuzz::replay("nrrd_header", fuzz::nrrd_header), 4u); }
TEST(FuzzCorpus, Inflate) { EXPECT_EQ(fuzz::replay("inflate", fuzz::inflate), 3u); }
TEST(FuzzCorpus, Bunzip) { EXPECT_EQ(fuzz::replay("bunzip", fuzz::bunzip), 3u); }
TEST(FuzzCorpus, LegacyVtk) { EXPECT_EQ(fuzz::replay("legacy_vtk", fuzz::legacy_vtk), 4u); }
TEST(FuzzCorpus, MetaImage) { EXPECT_EQ(fuzz::replay("meta_image", fuzz::meta_image), 2u); }
TEST(FuzzCorpus, NrrdVolume) { EXPECT_EQ(fuzz::replay("nrrd_volume", fuzz::nrrd_volume), 7u); }
TEST(FuzzCorpus, MetaImageVolume) {
  EXPECT_EQ(fuzz::replay("meta_image_volume", fuzz::meta_image_volume), 3u);
}
TEST(FuzzCorpus, VtiVolume) { EXPECT_EQ(fuzz::replay("vti_volume", fuzz::vti_volume), 2u); }
TEST(FuzzCorpus, NiftiVolume) { EXPECT_EQ(fuzz::replay("nifti_volume", fuzz::nifti_volume), 5u); }
TEST(FuzzCorpus, MrcVolume) { EXPECT_EQ(fuzz::replay("mrc_volume", fuzz::mrc_volume), 3u); }
TEST(FuzzCorpus, NumpyArray) { EXPECT_EQ(fuzz::replay("numpy_array", fuzz::numpy_array), 4u); }
TEST(FuzzCorpus, PackedVti) { EXPECT_EQ(fuzz::replay("packed_vti", fuzz::packed_vti), 5u); }
TEST(FuzzCorpus, SpyDump) { EXPECT_EQ(fuzz::replay("spy_dump", fuzz::spy_dump), 2u); }
TEST(FuzzCorpus, MesherReply) { EXPECT_EQ(fuzz::replay("mesher_reply", fuzz::mesher_reply), 2u); }

}  // namespace
}  // namespace adamas
