// The files that a command is about to write, and those that it did.
#include "cli/outputs.h"

#include <fstream>

#include "base/error.h"
#include "cli/picture_files.h"
#include "image/codecs.h"
#include "image/image.h"
#include "image/temp_folder.h"
#include "settings/aovs.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;

class Outputs : public TempFolder {};

TEST_F(Outputs, EachIsWrittenOnce) {
    EXPECT_NO_THROW(check_outputs({folder / "a", folder / "b"}, {folder / "c"}));
    expect_error([&] { check_outputs({folder / "a", folder / "b", folder / "a"}, {}); }, "would be written twice");
    expect_error([&] { check_outputs({folder / "a", folder / "." / "a"}, {}); }, "would be written twice");
    expect_error(
        [&] {
            check_outputs({"not there", std::filesystem::current_path() / "not there"}, {});
        },
        "would be written twice");
    fs::create_directory(folder / "in");
    expect_error([&] { check_outputs({folder / "a", folder / "in" / ".." / "a"}, {}); }, "would be written twice");
    put("a", "");
    fs::create_symlink(folder / "a", folder / "link");
    expect_error([&] { check_outputs({folder / "a", folder / "link"}, {}); }, "would be written twice");
}

TEST_F(Outputs, AnInputIsNeverOverwritten) {
    const fs::path input = put("scene.obj", "v 0 0 0\n");
    expect_error([&] { check_outputs({input}, {input}); }, "is an input and would be overwritten");
    fs::create_symlink(input, folder / "link");
    expect_error([&] { check_outputs({folder / "link"}, {input}); }, "is an input and would be overwritten");
    EXPECT_NO_THROW(check_outputs({folder / "a"}, {input, ""}));
    EXPECT_EQ(get(input), "v 0 0 0\n");
}

TEST_F(Outputs, WhereNothingCanBeWrittenIsSaidBeforehand) {
    expect_error([&] { check_outputs({folder}, {}); }, folder.string());
    EXPECT_NO_THROW(check_outputs({folder / "new" / "a", folder / "new" / "b", folder / "none" / ".." / "c"}, {}));
    EXPECT_EQ(files(), 0u) << "checking makes nothing";
    put("file", "");
    expect_error([&] { check_outputs({folder / "file" / "a"}, {}); }, "is not a folder");
    expect_error([&] { check_outputs({folder / "new" / "a", folder / "new"}, {}); }, "would be a file and the folder");
    expect_error([&] { check_outputs({folder / "new", folder / "new" / "a"}, {}); }, "would be a file and the folder");
    EXPECT_EQ(files(), 1u);
}

TEST_F(Outputs, FoldersAreMadeWhenAFileIsWritten) {
    store_file(folder / "a" / "b" / "c.txt", "text");
    EXPECT_EQ(get(folder / "a" / "b" / "c.txt"), "text");
    store_file(folder / "none" / ".." / "d.txt", "text");
    EXPECT_FALSE(fs::exists(folder / "none"));
    const auto fails = [](const fs::path&) { throw Error("half-written"); };
    EXPECT_THROW(write_atomically(folder / "new" / "deep" / "e.txt", fails), Error);
    EXPECT_FALSE(fs::exists(folder / "new"));
    EXPECT_THROW(write_atomically(folder / "a" / "f" / "e.txt", fails), Error);
    EXPECT_FALSE(fs::exists(folder / "a" / "f"));
    EXPECT_TRUE(fs::exists(folder / "a" / "b" / "c.txt"));
    EXPECT_TRUE(write_if_absent(folder / "g" / "h.txt", [](const fs::path& path) { std::ofstream(path) << "x"; }));
    EXPECT_EQ(get(folder / "g" / "h.txt"), "x");
}

TEST(PictureFiles, FormatsFollowFromTheName) {
    const auto checked = [](const char* name, bool layers, bool transparent) {
        RenderArguments a;
        a.output = name;
        a.exr_layers = layers;
        if (transparent) a.background.emplace();
        check_picture_name(a);
    };
    for (const char* name : {"a.png", "a.exr", "a.hdr", "a.PNG", "b.tiff.Exr", "-"})
        EXPECT_NO_THROW(checked(name, false, false)) << name;
    for (const char* name : {"a", "a.jpg", "png", ".png", "a.png.", "a.png/b"})
        expect_error([&] { checked(name, false, false); }, "name it .png, .exr or .hdr");
    EXPECT_NO_THROW(checked("a.exr", true, true));
    EXPECT_THROW(checked("a.png", true, false), Error) << "only an EXR has layers";
    EXPECT_NO_THROW(checked("a.png", false, true));
    expect_error([&] { checked("a.hdr", false, true); }, "--background transparent needs an alpha channel");
}

TEST(PictureFiles, WhatIsShownFollowsFromTheName) {
    EXPECT_TRUE(shows_radiance("a.exr"));
    EXPECT_TRUE(shows_radiance("a.HDR"));
    EXPECT_FALSE(shows_radiance("a.png"));
    EXPECT_FALSE(shows_radiance("-"));
}

TEST(PictureFiles, AuxiliaryPicturesStandBesideThePicture) {
    EXPECT_EQ(paths_beside("x/a.png", {Aov::normal}, false), Paths({"x/a.normal.exr"}));
    EXPECT_EQ(paths_beside("a.b.hdr", {Aov::depth}, false), Paths({"a.b.depth.exr"}));
    EXPECT_EQ(paths_beside("a.exr", {Aov::depth, Aov::normal}, true), Paths()) << "they are layers of it";
    size_t with_heat_map = 0;
    for (const Aov aov : values_of<Aov>()) {
        const Paths paths = paths_beside("a.png", {aov}, false);
        ASSERT_EQ(paths.size(), cost_field(aov) ? 2u : 1u);
        EXPECT_EQ(paths[0], fmt::format("a.{}.exr", name_of(aov)));
        if (!cost_field(aov)) continue;
        EXPECT_EQ(paths[1], heat_map_path("a.png", aov));
        with_heat_map++;
    }
    EXPECT_EQ(with_heat_map, std::size(kRayCostFields));
}

TEST_F(Outputs, APictureIsWrittenWithAllThatGoesWithIt) {
    Picture picture;
    picture.width = 2;
    picture.height = 1;
    picture.radiance = {{0.25f, 0.5f, 1, 1}, {2, 4, 8, 1}};
    picture.encoded = {0xFF102030, 0xFF405060};
    picture.aovs.depth = {1.5f, 3};
    picture.aovs.costs.resize(2);
    picture.aovs.costs[0].steps = 3;
    picture.aovs.costs[1].steps = 6;
    write_picture(picture, {{Aov::depth, Aov::cost_steps}, false, {}}, folder / "a.png");
    write_picture(picture, {}, folder / "b.exr");
    EXPECT_EQ(files(), 5u);
    EXPECT_EQ(read_ldr(folder / "a.png").pixels, picture.encoded);
    EXPECT_EQ(read_hdr(folder / "b.exr").pixels, picture.radiance);
    EXPECT_EQ(read_hdr(folder / "a.depth.exr").at(1, 0).x, 3);
    EXPECT_EQ(read_hdr(folder / "a.cost_steps.exr").at(0, 0).x, 3);
    const Image8 heat = read_ldr(folder / "a.cost_steps.png");
    EXPECT_NE(heat.pixels[0], heat.pixels[1]);
}

}  // namespace
}  // namespace peelray
