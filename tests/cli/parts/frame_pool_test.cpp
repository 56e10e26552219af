// Frames that other threads write: the same files for any number of them.
#include "cli/frame_pool.h"

#include <fmt/format.h>

#include <map>
#include <random>

#include "cli/picture_files.h"
#include "image/temp_folder.h"

namespace peelray {
namespace {

using FramePools = TempFolder;

Picture frame(uint32_t number) {
    Picture picture;
    picture.width = 96;
    picture.height = 64;
    std::mt19937 random(number);
    for (uint32_t i = 0; i < 96 * 64; i++) {
        picture.encoded.push_back(i * number | 0xff000000);
        picture.radiance.push_back(glm::vec4(float(random() % 1000) * 0.01f, float(i % 96), float(i / 96), 1));
        picture.aovs.depth.push_back(float(i + number));
        picture.aovs.normal.push_back(glm::vec4(0, 1, 0, 0));
    }
    return picture;
}

TEST_F(FramePools, FilesAreTheSameForAnyNumberOfThreads) {
    std::map<std::string, std::string> first;
    for (const size_t threads : {1, 2, 8}) {
        const PictureFiles beside{{Aov::depth, Aov::normal}, false, {}}, layers{{Aov::depth, Aov::normal}, true, {}};
        FramePool pool(threads);
        for (uint32_t i = 0; i < 24; i++) {
            const auto write = [&, i](const Picture& picture) {
                write_picture(picture, beside, folder / fmt::format("f{}.png", i));
                write_picture(picture, layers, folder / fmt::format("f{}.exr", i));
            };
            pool.add(frame(i), write, {}, {});
            if (std::optional<Picture> spare = pool.spare()) {
                EXPECT_EQ(spare->encoded.size(), 96u * 64);
                EXPECT_EQ(spare->aovs.depth.size(), 0u);
            }
        }
        pool.finish({});
        EXPECT_EQ(pool.finished(), 24u);
        std::map<std::string, std::string> all;
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            all[entry.path().filename()] = get(entry.path());
        EXPECT_EQ(all.size(), 24u * 4);
        if (first.empty()) first = all;
        EXPECT_TRUE(all == first) << threads;
        std::filesystem::remove_all(folder);
        std::filesystem::create_directory(folder);
    }
}

TEST_F(FramePools, AnErrorIsSaidOnceAndLeavesNoHalfFile) {
    std::filesystem::create_directory(folder / "f5.png");  // no file can be written there
    FramePool pool(4);
    std::string said;
    try {
        for (uint32_t i = 0; i < 100; i++)
            pool.add(frame(i),
                     [&, i](const Picture& picture) { write_picture(picture, {}, folder / fmt::format("f{}.png", i)); },
                     {}, {});
        pool.finish({});
    } catch (const Error& error) {
        said = error.text();
    }
    EXPECT_NE(said.find("f5.png"), std::string::npos) << said;
    EXPECT_NO_THROW(pool.finish({}));
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().filename();
        EXPECT_FALSE(name.starts_with(".")) << name;
        if (name == "f5.png") continue;
        EXPECT_EQ(read_ldr(entry.path()).width, 96u) << name;
        files++;
    }
    EXPECT_GE(files, 5u);
    EXPECT_LT(files, 5u + 10 + 4) << "what waited was dropped";
}

}  // namespace
}  // namespace peelray
