// Which options choose the cubes where no tracer is named.
#include <gtest/gtest.h>

#include <set>

#include "cli/arguments.h"

namespace peelray {
namespace {

TEST(CubeOptions, AreThoseOfCubesAndOfMeasuringADevice) {
    RenderArguments arguments;
    std::set<std::string> names;
    for (const SettingEntry& entry : options_of(arguments))
        if (entry.info.of_cubes) names.insert(entry.info.name);
    EXPECT_EQ(names,
              (std::set<std::string>{"batch", "block", "builder", "counters", "depth", "hit", "ldc", "merge", "rebuild",
                                     "refine", "repeat", "routing", "tolerance", "traversal", "visibility"}));
}

}  // namespace
}  // namespace peelray
