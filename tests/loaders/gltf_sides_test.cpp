// Which sides of a glTF file's faces are shown.
#include "loaders/scene_files.h"
#include "scene/sidedness.h"

namespace peelray::testing {
namespace {

TEST(GltfSides, OnlyMaterialsInUseCount) {
    const TempFolder folder;
    json gltf = square();
    EXPECT_TRUE(has_single_sided(load(folder, gltf))) << "without a material the format's default holds";
    gltf["materials"] = {{{"doubleSided", true}}, {{"doubleSided", false}}};
    primitive(gltf)["material"] = 0;
    const Scene scene = load(folder, gltf);
    EXPECT_EQ(scene.materials.size(), 3u) << "the default one as well";
    EXPECT_FALSE(has_single_sided(scene));
    primitive(gltf)["material"] = 1;
    EXPECT_TRUE(has_single_sided(load(folder, gltf)));
}

}  // namespace
}  // namespace peelray::testing
