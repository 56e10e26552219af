// Files, folders and machines that are not as they should be: status 1, one line, nothing left behind.
#include <limits>

#include "cli/program_fixture.h"

namespace peelray {
namespace {

class BadInput : public ProgramTest {
  protected:
    /// The scene is refused by render, trace and info alike.
    void expect_bad_scene(const std::string& name, const std::string& says) const {
        SCOPED_TRACE(name);
        expect_refused(render(in(name)), 1, says);
        expect_refused(run({"info", in(name)}), 1, says);
        put("rays.npy", rays_npy({0, 0, 5, 0, 0, 0, -1, 9}));
        expect_refused(run({"trace", in(name), "--rays", in("rays.npy"), "--out", out("hits.npy")}), 1, says);
    }
    void expect_bad_gltf(const nlohmann::json& gltf, const std::string& says,
                         const std::string& bytes = square_bytes()) const {
        put("square.bin", bytes);
        put("bad.gltf", gltf.dump());
        expect_bad_scene("bad.gltf", says);
    }
};

TEST_F(BadInput, FilesThatHoldNoMesh) {
    expect_bad_scene("none.obj", "no such file");
    expect_bad_scene("none.gltf", "no such file");
    std::filesystem::create_directory(folder / "folder.glb");
    expect_bad_scene("folder.glb", "not a regular file");
    put("picture.jpg", "x");
    expect_bad_scene("picture.jpg", "the extension \".jpg\" is unknown");
    expect_refused(
        run({"info", "builtin:moon"}), 1,
        "known are teapots, glass, tree, leaves, room, walker, desk, kitchen, bricks, cloth, blob:N, waves, particles");
    expect_refused(run({"info", "builtin:blob:7"}), 1, "8 to 10000000");
    expect_refused(run({"info", "builtin:blob:10000001"}), 1, "8 to 10000000");
    expect_refused(run({"info", ""}), 1, "");
    for (const std::string extension : {"gltf", "glb", "obj", "ply", "stl", "off"}) {
        const std::string empty = std::string("empty.") + extension, text = std::string("text.") + extension;
        put(empty, "");
        expect_bad_scene(empty, "empty");
        put(text, "Dear reader,\nthis is a letter and no mesh.\n");
        expect_bad_scene(text, text);
    }
}

TEST_F(BadInput, TruncatedFiles) {
    const std::string glb_json = square_gltf().dump();
    const auto word = [](uint32_t value) { return bytes_of(std::vector<uint32_t>{value}); };
    const std::string glb =
        "glTF" + word(2) + word(20 + uint32_t(glb_json.size())) + word(uint32_t(glb_json.size())) + "JSON" + glb_json;
    put("cut.glb", glb.substr(0, glb.size() / 2));
    expect_bad_scene("cut.glb", "truncated");
    put("cut.gltf", glb_json.substr(0, glb_json.size() / 2));
    expect_bad_scene("cut.gltf", "cut.gltf");
    put("cut.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n");
    expect_bad_scene("cut.off", "cut.off");
    put("cut.ply",
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n1234");
    expect_bad_scene("cut.ply", "cut.ply");
    put("cut.stl", std::string(80, ' ') + word(100) + "1234");
    expect_bad_scene("cut.stl", "cut.stl");
}

TEST_F(BadInput, GltfBuffersAndImages) {
    auto gltf = square_gltf();
    gltf["buffers"][0]["uri"] = "gone.bin";
    expect_bad_gltf(gltf, "gone.bin: no such file");
    expect_bad_gltf(square_gltf(), "too short", "123");
    gltf = square_gltf();
    gltf["images"] = {{{"uri", "gone.png"}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    gltf["meshes"][0]["primitives"][0]["material"] = 0;
    put("square.bin", square_bytes());
    put("noted.gltf", gltf.dump());
    const Outcome noted = render(in("noted.gltf"));
    expect_done(noted, {"a.png"});
    EXPECT_NE(noted.err.find("the image file gone.png is missing: the factors are used"), std::string::npos)
        << noted.err;
    std::filesystem::remove(out("a.png"));
    put("short.png", "\x89PNG\r\n\x1a\n");
    gltf["images"][0]["uri"] = "short.png";
    put("damaged.gltf", gltf.dump());
    const Outcome damaged = render(in("damaged.gltf"));
    expect_done(damaged, {"a.png"});
    EXPECT_NE(damaged.err.find("short.png"), std::string::npos) << damaged.err;
    EXPECT_NE(damaged.err.find("the factor is used"), std::string::npos) << damaged.err;
}

TEST_F(BadInput, GltfRanges) {
    auto gltf = square_gltf();
    gltf["accessors"][0]["count"] = 5;
    expect_bad_gltf(gltf, "60 bytes");
    gltf = square_gltf();
    gltf["meshes"][0]["primitives"][0]["indices"] = 7;
    expect_bad_gltf(gltf, "accessors");
    gltf = square_gltf();
    gltf["nodes"][0]["mesh"] = 3;
    expect_bad_gltf(gltf, "has 1 mesh");
    gltf = square_gltf();
    gltf["materials"] = {{{"alphaMode", "MASK"}, {"alphaCutoff", -0.5}}};
    expect_bad_gltf(gltf, "alphaCutoff -0.5");
    expect_bad_gltf(square_gltf(), "index", square_bytes({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, {0, 1, 9, 0, 2, 3}));
    put("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    expect_bad_scene("bad.obj", "bad.obj");
    put("bad.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n");
    expect_bad_scene("bad.off", "bad.off");
}

TEST_F(BadInput, VerticesThatAreNoPlaces) {
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
        expect_bad_gltf(square_gltf(), "finite", square_bytes({value, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}));
    put("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expect_bad_scene("nan.obj", "nan.obj");
    put("inf.off", "OFF\n3 1 0\n1e999 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    expect_bad_scene("inf.off", "inf.off");
}

TEST_F(BadInput, NothingToSee) {
    // Triangles without area are no surface; `info` still tells of them.
    put("line.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nv 5 5 5\nf 1 2 3\nf 1 1 4\n");
    put("rays.npy", rays_npy({0, 0, 5, 0, 0, 0, -1, 9}));
    expect_refused(render(in("line.obj")), 1, "none of its 2 triangles has an area");
    expect_refused(run({"trace", in("line.obj"), "--rays", in("rays.npy"), "--out", out("hits.npy")}), 1,
                   "none of its 2 triangles has an area");
    EXPECT_NE(run({"info", in("line.obj")}).out.find("2 (2 without area)"), std::string::npos);
    put("points.obj", "v 0 0 0\nv 1 1 1\n");
    expect_bad_scene("points.obj", "points.obj");
    auto gltf = square_gltf();
    gltf["scenes"][0]["nodes"] = nlohmann::json::array();
    gltf["scenes"][0].erase("nodes");
    expect_bad_gltf(gltf, "no triangles");
    expect_bad_gltf({{"asset", {{"version", "2.0"}}}}, "no triangles");
}

TEST_F(BadInput, ExtensionsAndForeignFolders) {
    auto gltf = square_gltf();
    gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"EXT_teleport"};
    expect_bad_gltf(gltf, "EXT_teleport");
    std::filesystem::create_directory(folder / "inside");
    put("secret.bin", square_bytes());
    for (const std::string& uri :
         std::vector<std::string>{"../secret.bin", "%2e%2e/secret.bin", "a/../../secret.bin", in("secret.bin"),
                                  std::string("file://") + in("secret.bin")}) {
        gltf = square_gltf();
        gltf["buffers"][0]["uri"] = uri;
        put("inside/bad.gltf", gltf.dump());
        expect_bad_scene("inside/bad.gltf", "refused to read");
    }
    std::filesystem::create_symlink(folder / "secret.bin", folder / "inside/link.bin");
    gltf["buffers"][0]["uri"] = "link.bin";
    put("inside/bad.gltf", gltf.dump());
    expect_bad_scene("inside/bad.gltf", "refused to read");
}

TEST_F(BadInput, VariantsThatTheSceneDoesNotHave) {
    auto gltf = square_gltf();
    gltf["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "day"}}, {{"name", "night"}}};
    put("square.bin", square_bytes());
    put("square.gltf", gltf.dump());
    put("cube.obj", kCube);
    put("rays.npy", rays_npy({0, 0, 5, 0, 0, 0, -1, 9}));
    for (const auto& [scene, says] : {std::pair(in("square.gltf"), "choose another --variant: day, night"),
                                      std::pair(in("cube.obj"), "leave out --variant")}) {
        expect_refused(run({"render", scene, "-o", out("a.png"), "--variant", "dusk"}), 1, says);
        expect_refused(run({"trace", scene, "--rays", in("rays.npy"), "--out", out("h.npy"), "--variant", "dusk"}), 1,
                       says);
    }
}

TEST_F(BadInput, NamesWithControlCharacters) {
    put("cube.obj", kCube);
    expect_refused(run({"info", in("a\nb\x1b[2J.obj")}), 1, "no such file");
    expect_refused(run({"render", in("cube.obj"), "-o", out("a\nb.jpg")}), 1, ".png, .exr or .hdr");
    expect_refused(run({"render", in("cube.obj"), "-o", out("a.png"), "--size", "1\n2"}), 2, "--size");
}

TEST_F(BadInput, OutputsThatCannotBeWritten) {
    put("cube.obj", kCube);
    put("file", "x");
    std::filesystem::create_directory(folder / "folder.png");
    const auto to = [&](const std::string& path) {
        return run({"render", in("cube.obj"), "-o", path, "--size", "64x48"});
    };
    expect_refused(to(in("file/deep/a.png")), 1, "is not a folder");
    std::filesystem::create_symlink(folder / "nowhere", folder / "broken");
    expect_refused(to(in("broken/a.png")), 1, "broken is not a folder");
    expect_refused(to(in("folder.png")), 1, "it is a folder");
    expect_refused(to(in("file/a.png")), 1, "is not a folder");
    expect_refused(to("/proc/a.png"), 1, "cannot write");
    expect_refused(to(out("a.jpg")), 1, "name it .png, .exr or .hdr");
    expect_refused(to(out("a")), 1, "name it .png, .exr or .hdr");
    expect_refused(to(""), 1, "name it .png, .exr or .hdr");
    expect_refused(to("/proc/new/a.png"), 1, "cannot write");
    expect_refused(render(in("cube.obj"), {"--stats", in("file/a.json")}), 1, "is not a folder");
    expect_refused(render(in("cube.obj"), {"--stats", out("a.png/a.json")}), 1, "would be a file and the folder of");
    put("rays.npy", rays_npy({0, 0, 5, 0, 0, 0, -1, 9}));
    expect_refused(run({"trace", in("cube.obj"), "--rays", in("rays.npy"), "--out", in("file/h.npy")}), 1,
                   "is not a folder");
    expect_refused(run({"trace", in("cube.obj"), "--rays", in("rays.npy"), "--out", in("rays.npy")}), 1, "is an input");
}

TEST_F(BadInput, NoFolderIsMadeForWhatFails) {
    put("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(render(in("nan.obj"), {}, "new/deep/a.png").status, 1);
    EXPECT_EQ(render("builtin:blob:8", {"--device", "99", "--stats", out("stats/a.json")}, "new/a.png").status, 1);
    EXPECT_EQ(outputs(), std::vector<std::string>());
}

TEST_F(BadInput, FailureLeavesAnOldPictureAlone) {
    put("out/a.png", "old");
    put("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(render(in("nan.obj")).status, 1);
    EXPECT_EQ(render("builtin:blob:8", {"--device", "99"}).status, 1);
    EXPECT_EQ(get(out("a.png")), "old");
    EXPECT_EQ(outputs(), std::vector<std::string>{"a.png"});
}

TEST_F(BadInput, EnvironmentMaps) {
    put("cube.obj", kCube);
    put("text.hdr", "no picture\n");
    put("cut.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 64 +X 64\n123");
    put("empty.exr", "");
    expect_refused(render(in("cube.obj"), {"--env", in("gone.hdr")}), 1, "gone.hdr");
    expect_refused(render(in("cube.obj"), {"--env", in("text.hdr")}), 1, "text.hdr");
    expect_refused(render(in("cube.obj"), {"--env", in("cut.hdr")}), 1, "cut.hdr");
    expect_refused(render(in("cube.obj"), {"--env", in("empty.exr")}), 1, "empty");
    expect_refused(render(in("cube.obj"), {"--env", folder}), 1, "cannot read");
}

TEST_F(BadInput, RayFiles) {
    put("cube.obj", kCube);
    const std::string ray = bytes_of(std::vector<float>(8, 1.0f));
    const std::vector<std::pair<std::string, std::string>> files = {
        {"", "empty"},
        {"rays, but not for NumPy", "not a .npy file"},
        {npy("'<f4'", "(1, 6)", ray.substr(0, 24)), "(n, 8)"},
        {npy("'<f4'", "(8,)", ray), "(n, 8)"},
        {npy("'<f4'", "(1, 1, 8)", ray), "(n, 8)"},
        {npy("'<f8'", "(1, 8)", ray + ray), "float32"},
        {npy("'<i4'", "(1, 8)", ray), "float32"},
        {npy("'>f4'", "(1, 8)", ray), "float32"},
        {npy("'<f4'", "(1, 8)", ray, true), "Fortran"},
        {npy("'<f4'", "(2, 8)", ray), "truncated"},
        {npy("'<f4'", "(1, 8)", ray + "x"), "33"},
        {npy("'<f4'", "(99999999999, 8)", ray), ""},
        {npy("'<f4'", "(1, 8)", ray).substr(0, 30), ""},
    };
    for (const auto& [bytes, says] : files) {
        SCOPED_TRACE(bytes.substr(0, 80));
        put("rays.npy", bytes);
        expect_refused(run({"trace", in("cube.obj"), "--rays", in("rays.npy"), "--out", out("hits.npy")}), 1, says);
    }
    expect_refused(run({"trace", in("cube.obj"), "--rays", in("gone.npy"), "--out", out("hits.npy")}), 1, "gone.npy");
    expect_refused(run({"trace", in("cube.obj"), "--rays", folder, "--out", out("hits.npy")}), 1, "cannot read");
}

TEST_F(BadInput, NoVulkanDriver) {
    put("cube.obj", kCube);
    put("rays.npy", rays_npy({0, 0, 5, 0, 0, 0, -1, 9}));
    const std::map<std::string, std::string> none = {{"VK_ICD_FILENAMES", in("none.json")},
                                                     {"VK_DRIVER_FILES", in("none.json")}};
    expect_refused(run({"devices"}, none), 1, "mesa-vulkan-drivers");
    expect_refused(run({"render", in("cube.obj"), "-o", out("a.png"), "--tracer", "ldc"}, none), 1,
                   "mesa-vulkan-drivers");
    expect_refused(run({"trace", in("cube.obj"), "--rays", in("rays.npy"), "--out", out("hits.npy")}, none), 1,
                   "mesa-vulkan-drivers");
    EXPECT_EQ(run({"info", in("cube.obj")}, none).status, 0);
    EXPECT_EQ(run({"render", in("cube.obj"), "-o", out("a.png"), "--size", "64x48"}, none).status, 0) << "on the CPU";
}

}  // namespace
}  // namespace peelray
