// The manifest beside a sequence: when it is written, when it is compared, and what is said of a difference.
#include "cli/manifest.h"
#include "image/temp_folder.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json manifest() {
    return {{"manifest", 1},
            {"commit", "abc"},
            {"scene", "a.glb"},
            {"settings", {{"--ldc", "256"}, {"--floor", nullptr}, {"--hit", "exact"}, {"--spp", "1"}}},
            {"files", {{"a.glb", "xxh128:1"}}}};
}

class ManifestFile : public TempFolder {
  protected:
    fs::path path() const { return manifest_path(folder / "f_%d.png"); }
    Json read() const { return Json::parse(get(path())); }
    /// What is said when a run that shares its frames finds `before`.
    void expect_difference(const Json& before, const Json& now, const std::string& says) {
        fs::remove(path());
        settle_manifest(path(), before, false);
        const std::string text = get(path());
        expect_error([&] { settle_manifest(path(), now, true); }, says);
        EXPECT_EQ(get(path()), text) << "it is left as it was";
    }
};

TEST_F(ManifestFile, StandsBesideThePictures) {
    EXPECT_EQ(manifest_path("x/f_%05d.exr"), "x/f_%05d.exr.json");
}

TEST_F(ManifestFile, IsWrittenWhereThereIsNone) {
    for (const bool shares : {false, true}) {
        fs::remove(path());
        settle_manifest(path(), manifest(), shares);
        EXPECT_EQ(read(), manifest());
        EXPECT_EQ(files(), 1u);
    }
}

TEST_F(ManifestFile, ThatSaysTheSameIsLeftAlone) {
    settle_manifest(path(), manifest(), false);
    const auto old = fs::file_time_type::clock::now() - std::chrono::hours(5);
    fs::last_write_time(path(), old);
    const auto before = fs::last_write_time(path());
    settle_manifest(path(), manifest(), false);
    settle_manifest(path(), manifest(), true);
    EXPECT_EQ(fs::last_write_time(path()), before);
}

TEST_F(ManifestFile, OfAnotherRunIsReplacedUnlessFramesAreShared) {
    Json other = manifest();
    other["settings"]["--ldc"] = "512";
    settle_manifest(path(), other, false);
    settle_manifest(path(), manifest(), false);
    EXPECT_EQ(read(), manifest());
    put("f_%d.png.json", "no JSON");
    settle_manifest(path(), manifest(), false);
    EXPECT_EQ(read(), manifest());
}

TEST_F(ManifestFile, DifferencesAreSaid) {
    Json now = manifest();
    now["settings"]["--ldc"] = "512";
    expect_difference(manifest(), now, "the frames that are there were made differently: --ldc was 256, is 512 (");
    now = manifest();
    now["settings"]["--floor"] = true;
    expect_difference(manifest(), now, "--floor was not given, is given");
    now = manifest();
    now["settings"].erase("--hit");
    expect_difference(manifest(), now, "--hit was exact, is not given");
    now = manifest();
    now["commit"] = "def";
    expect_difference(manifest(), now, "the commit was abc, is def");
    now = manifest();
    now["files"]["a.glb"] = "xxh128:2";
    expect_difference(manifest(), now, "the content of a.glb was xxh128:1, is xxh128:2");
    // Of another scene the files differ of course.
    now["scene"] = "b.glb";
    expect_difference(manifest(), now, "made differently: the scene was a.glb, is b.glb (");
}

TEST_F(ManifestFile, OfManyDifferencesTheFirstAreSaid) {
    Json now = manifest();
    for (const char* flag : {"--ldc", "--hit", "--spp", "--floor"}) now["settings"][flag] = "other";
    now["commit"] = "def";
    expect_difference(
        manifest(), now,
        "the commit was abc, is def; --ldc was 256, is other; --floor was not given, is other; and 2 more");
}

TEST_F(ManifestFile, ThatIsNoneIsSaid) {
    for (const char* text : {"", "[]", "{}", "{\"manifest\": 2}", "no JSON"}) {
        put("f_%d.png.json", text);
        expect_error([&] { settle_manifest(path(), manifest(), true); }, "is no manifest of a sequence");
        EXPECT_EQ(get(path()), text);
    }
}

}  // namespace
}  // namespace peelray
