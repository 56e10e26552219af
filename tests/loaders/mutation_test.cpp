// Changed files of every format end with a scene or an Error of one line. mutated_files does the same many times over.

#include "loaders/mutation.h"

#include <set>

#include "image/image.h"
#include "loaders/load.h"
#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

TEST(Mutation, SamplesAreValid) {
    const TempFolder folder;
    folder.write("t.png", tiny_png());
    for (const std::string& format : mutation_formats())
        for (const Sample& sample : samples(format)) {
            const std::string file = folder.write(sample.name, sample.file(sample.bytes));
            if (format == "exr" || format == "hdr") {
                EXPECT_FALSE(read_hdr(file).pixels.empty()) << sample.name;
            } else if (format != "mtl") {
                EXPECT_FALSE(flatten(load_scene(file)).triangles.empty()) << sample.name;
            }
        }
}

TEST(Mutation, ChangesDifferAndCanBeRepeated) {
    const std::string good = samples("off")[0].bytes;
    std::set<std::string> seen;
    size_t shorter = 0, longer = 0;
    for (uint64_t seed = 0; seed < 500; ++seed) {
        const std::string bad = Mutation(seed)(good);
        EXPECT_EQ(bad, Mutation(seed)(good));
        seen.insert(bad);
        shorter += bad.size() < good.size();
        longer += bad.size() > good.size();
    }
    EXPECT_GT(seen.size(), 450u);
    EXPECT_GT(shorter, 50u);
    EXPECT_GT(longer, 50u);
    EXPECT_EQ(Mutation(1)(""), "");
}

TEST(Mutation, EveryChangedFileLoadsOrGivesOneLine) {
    for (const std::string& format : mutation_formats()) {
        const TempFolder folder;
        const MutationResult result = load_mutations(format, 500, 1, folder.path().string());
        EXPECT_EQ(result.loaded + result.refused, 500u) << format;
        EXPECT_GT(result.loaded, 10u) << format;
        EXPECT_EQ(result.wrong, std::vector<std::string>()) << format;
    }
}

}  // namespace
}  // namespace peelray::testing
