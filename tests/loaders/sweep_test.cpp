// Loads every model that lies in shared/models: real ones with their known number of triangles, broken ones without a
// crash.

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "loaders/damage.h"
#include "loaders/load.h"
#include "loaders/scene_files.h"
#include "motion/animation.h"

namespace peelray::testing {
namespace {

namespace fs = std::filesystem;

bool is_scene(const fs::path& path) {
    static const std::set<std::string> extensions = {".gltf", ".glb", ".obj", ".ply", ".stl", ".off"};
    return extensions.count(path.extension().string()) > 0;
}

struct Source {
    int64_t triangles = -1;
    std::string notes;
};

std::map<std::string, Source> read_sources() {
    std::map<std::string, Source> out;
    std::ifstream stream(std::string(PEELRAY_MODELS) + "/SOURCES.tsv");
    std::string line;
    std::getline(stream, line);
    while (std::getline(stream, line)) {
        std::vector<std::string> columns;
        std::stringstream row(line);
        for (std::string column; std::getline(row, column, '\t');) columns.push_back(column);
        if (columns.size() < 6) continue;
        Source source;
        if (!columns[4].empty() && std::all_of(columns[4].begin(), columns[4].end(), ::isdigit))
            source.triangles = std::stoll(columns[4]);
        source.notes = columns[5];
        // "7724 triangles drawn with instances" is what we show; the column itself counts the file's meshes once.
        const size_t drawn = source.notes.find(" triangles drawn with instances");
        if (drawn != std::string::npos) {
            const size_t begin = source.notes.find_last_not_of("0123456789", drawn - 1);
            source.triangles = std::stoll(source.notes.substr(begin + 1));
        }
        out[columns[0]] = source;
    }
    return out;
}

/// Shows the scene at rest and at some moments of its animations.
void show_all(const Scene& scene) {
    flatten(scene);
    for (size_t i = 0; i < scene.animations.size(); ++i)
        for (const double time : {0.0, 0.3, 1.1}) {
            const Geometry moved = flatten(scene, moment_of(scene, std::to_string(i), time));
            for (const glm::vec3& n : moved.normals) ASSERT_NEAR(glm::length(n), 1, 1e-3);
        }
}

/// Files that rightly give an error, with a word of it.
const std::map<std::string, std::string> expected_errors = {};

/// Files whose default scene shows another number of triangles than the file holds.
const std::map<std::string, int64_t> shown_triangles = {
    {"gltf/MultipleScenes/MultipleScenes.gltf", 2},  // of the two scenes' 3
    {"gltf/SimpleInstancing.glb", 1500}};            // 125 instances of a cube

TEST(Sweep, RealModelsLoadWithTheirTriangles) {
    const fs::path models = PEELRAY_MODELS;
    if (!fs::exists(models / "SOURCES.tsv"))
        GTEST_SKIP() << "no models at " << models << "; see shared/models/README.md";
    const std::map<std::string, Source> sources = read_sources();
    int loaded = 0;
    for (const char* part : {"meshes", "gltf", "skinned"})
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(models / part)) {
            if (!entry.is_regular_file() || !is_scene(entry.path())) continue;
            const std::string name = fs::relative(entry.path(), models).string();
            SCOPED_TRACE(name);
            if (const auto expected = expected_errors.find(name); expected != expected_errors.end()) {
                EXPECT_MENTIONS(error_of(entry.path().string()), expected->second);
                continue;
            }
            try {
                const Geometry g = flatten(load_scene(entry.path().string()));
                ++loaded;
                const auto source = sources.find(name);
                const auto shown = shown_triangles.find(name);
                int64_t expected = source == sources.end() ? -1 : source->second.triangles;
                if (shown != shown_triangles.end()) expected = shown->second;
                EXPECT_EQ(int64_t(g.triangles.size()), expected >= 0 ? expected : int64_t(g.triangles.size()));
                for (const glm::vec3& n : g.normals) ASSERT_NEAR(glm::length(n), 1, 1e-3);
            } catch (const Error& error) {
                // A part that the collection lacks is the collection's fault.
                EXPECT_MENTIONS(std::string(error.what()), "no such file");
                EXPECT_MENTIONS(std::string(error.what()), "AssetGenerator");
            }
        }
    EXPECT_GT(loaded, 50);
}

TEST(Sweep, BrokenModelsLoadOrGiveOneLine) {
    const fs::path models = PEELRAY_MODELS;
    if (!fs::exists(models / "malformed")) GTEST_SKIP() << "no models at " << models << "; see shared/models/README.md";
    int loaded = 0, refused = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(models / "malformed")) {
        if (!entry.is_regular_file() || !is_scene(entry.path())) continue;
        SCOPED_TRACE(entry.path().string());
        try {
            show_all(load_scene(entry.path().string()));
            ++loaded;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            ++refused;
        }
    }
    EXPECT_GT(loaded + refused, 150);
}

TEST(Sweep, DamageIsDoneAndAnEmptyFileStaysEmpty) {
    Damage damage;
    const std::string good(1000, '-');
    int cut = 0;
    for (int round = 0; round < 100; ++round) {
        const std::string bad = damage(good);
        cut += bad.size() < good.size();
        if (bad.size() == good.size()) {
            EXPECT_NE(bad, good);
        }
        EXPECT_LE(bad.size(), good.size());
        EXPECT_EQ(damage(""), "");
    }
    EXPECT_GT(cut, 5);
    EXPECT_LT(cut, 25);
}

/// The same, with bytes of good files overwritten and files cut, at places that a fixed generator picks.
TEST(Sweep, DamagedModelsLoadOrGiveOneLine) {
    const fs::path models = PEELRAY_MODELS;
    const std::vector<std::string> names = {"gltf/Box.glb",
                                            "gltf/BoxInterleaved.glb",
                                            "gltf/SimpleSparseAccessor/SimpleSparseAccessor.gltf",
                                            "gltf/BoxVertexColors.glb",
                                            "skinned/SimpleSkin-Embedded.gltf",
                                            "skinned/singleBlendshapeCube_sparse.glb",
                                            "skinned/AnimatedMorphCube.glb",
                                            "skinned/RiggedSimple.glb",
                                            "skinned/BoxAnimated.glb",
                                            "meshes/cornell_box.obj",
                                            "malformed/assimp/PLY/cube_binary.ply",
                                            "malformed/assimp/PLY/float-color.ply"};
    if (!fs::exists(models / names[0])) GTEST_SKIP() << "no models at " << models << "; see shared/models/README.md";
    const TempFolder folder;
    Damage damage;
    for (const std::string& name : names) {
        std::ifstream stream(models / name, std::ios::binary);
        const std::string good((std::istreambuf_iterator<char>(stream)), {});
        EXPECT_FALSE(good.empty()) << name << " is an empty file: nothing can be damaged in it";
        for (int round = 0; round < 300; ++round) {
            const std::string bad = damage(good);
            SCOPED_TRACE(name + " round " + std::to_string(round));
            try {
                show_all(load_scene(folder.write("bad" + fs::path(name).extension().string(), bad)));
            } catch (const Error& error) {
                EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            }
        }
    }
}

}  // namespace
}  // namespace peelray::testing
