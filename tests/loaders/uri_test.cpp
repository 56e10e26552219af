// A scene file never reads outside of its own folder, and what was read is known.
#include <set>

#include "loaders/load.h"
#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

/// The scene lies in inside/, the buffer it wants in the folder above.
class UriTest : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_.write("secret.bin", pack(unit_square));
        folder_.write("inside/near.bin", pack(unit_square));
        folder_.write("inside/deep/far.bin", pack(unit_square));
    }

    std::string scene(const std::string& uri) const {
        json gltf = square();
        gltf["buffers"][0]["uri"] = uri;
        return folder_.write("inside/scene.gltf", gltf.dump());
    }

    TempFolder folder_;
};

TEST_F(UriTest, InsideIsRead) {
    for (const char* uri :
         {"near.bin", "./near.bin", "deep/far.bin", "deep/../near.bin", "%6Eear.bin", "../inside/near.bin"})
        EXPECT_NO_THROW(load_scene(scene(uri))) << uri;
}

TEST_F(UriTest, TellsWhichFilesItRead) {
    json gltf = square();
    gltf["buffers"][0]["uri"] = "near.bin";
    gltf["buffers"].push_back({{"byteLength", 4}, {"uri", "deep/far.bin"}});
    gltf["images"] = {{{"uri", "deep/a.png"}}, {{"uri", "deep/unused.png"}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    primitive(gltf)["material"] = 0;
    folder_.write("inside/deep/a.png", tiny_png());
    folder_.write("inside/deep/unused.png", tiny_png());
    const std::string file = folder_.write("inside/scene.gltf", gltf.dump());
    const auto names = [](const std::string& scene) {
        std::vector<std::string> names;
        for (const std::filesystem::path& path : load_scene(scene).files) names.push_back(path.filename());
        return names;
    };
    const std::vector<std::string> read = names(file);
    ASSERT_FALSE(read.empty());
    EXPECT_EQ(read[0], "scene.gltf");
    EXPECT_EQ(std::set<std::string>(read.begin(), read.end()),
              (std::set<std::string>{"scene.gltf", "near.bin", "far.bin", "a.png"}));
    EXPECT_EQ(read.size(), 4u);

    folder_.write("inside/m.mtl", "newmtl x\nmap_Kd deep/a.png\n");
    const std::string obj =
        folder_.write("inside/a.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n");
    EXPECT_EQ(names(obj), (std::vector<std::string>{"a.obj", "m.mtl", "a.png"}));
    EXPECT_TRUE(load_scene("builtin:blob:8").files.empty());
}

TEST_F(UriTest, EscapesAreRefused) {
    for (const char* uri : {"../secret.bin", "deep/../../secret.bin", "%2e%2e/secret.bin", "%2E%2E%2Fsecret.bin",
                            "..%2fsecret.bin", "./../secret.bin"})
        EXPECT_MENTIONS(error_of(scene(uri)), "outside") << uri;
    EXPECT_MENTIONS(error_of(scene((folder_.path() / "secret.bin").string())), "absolute");
    EXPECT_MENTIONS(error_of(scene("/etc/passwd")), "absolute");
    EXPECT_MENTIONS(error_of(scene("%2Fetc%2Fpasswd")), "absolute");
    for (const char* uri :
         {"file:///etc/passwd", "http://localhost/a.bin", "https://localhost/a.bin", "C:/a.bin", "ftp:a"})
        EXPECT_MENTIONS(error_of(scene(uri)), "refused") << uri;
}

TEST_F(UriTest, SymbolicLinksMayNotLeadOut) {
    const std::filesystem::path inside = folder_.path() / "inside";
    std::filesystem::create_symlink("../secret.bin", inside / "link.bin");
    std::filesystem::create_directory_symlink("..", inside / "up");
    std::filesystem::create_symlink("near.bin", inside / "good.bin");
    EXPECT_MENTIONS(error_of(scene("link.bin")), "outside");
    EXPECT_MENTIONS(error_of(scene("up/secret.bin")), "outside");
    EXPECT_NO_THROW(load_scene(scene("good.bin")));
}

TEST_F(UriTest, OddUris) {
    EXPECT_MENTIONS(error_of(scene("")), "empty");
    EXPECT_MENTIONS(error_of(scene("near%2.bin")), "stray '%'");
    EXPECT_MENTIONS(error_of(scene("near.bin%00.png")), "zero byte");
    EXPECT_MENTIONS(error_of(scene("deep")), "regular file");
    error_of(scene(std::string(100000, 'a')));
}

TEST_F(UriTest, ImagesToo) {
    folder_.write("secret.png", tiny_png());
    json gltf = square();
    gltf["images"] = {{{"uri", "../secret.png"}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"] = json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
    EXPECT_MENTIONS(error_of(folder_.write("inside/scene.gltf", gltf.dump())), "outside");
}

TEST_F(UriTest, RelativeSceneNameInTheCurrentFolder) {
    const std::filesystem::path before = std::filesystem::current_path();
    scene("near.bin");
    std::filesystem::current_path(folder_.path() / "inside");
    EXPECT_NO_THROW(load_scene("scene.gltf"));
    std::filesystem::current_path(before);
}

TEST_F(UriTest, MaterialLibrariesAndTexturesOfObjFiles) {
    folder_.write("secret.mtl", "newmtl m\nKd 1 0 0\n");
    folder_.write("secret.png", tiny_png());
    folder_.write("inside/good.mtl", "newmtl m\nKd 0.5 0.25 0.125\nmap_Kd ../secret.png\n");
    const std::string body = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
    const Scene refused = load_scene(folder_.write("inside/a.obj", "mtllib ../secret.mtl\n" + body));
    ASSERT_EQ(refused.notes.size(), 1u);
    EXPECT_MENTIONS(refused.notes[0], "outside");
    for (const Material& m : refused.materials) EXPECT_NE(m.base_color, glm::vec3(1, 0, 0));
    const Scene textured = load_scene(folder_.write("inside/b.obj", "mtllib good.mtl\n" + body));
    EXPECT_TRUE(textured.textures.empty());
    ASSERT_EQ(textured.notes.size(), 1u);
    EXPECT_MENTIONS(textured.notes[0], "outside");
}

}  // namespace
}  // namespace peelray::testing
