// Errors that carry the settings at fault.
#include "base/error.h"

#include <gtest/gtest.h>

#include <functional>

namespace peelray {
namespace {

Error caught(const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& error) {
        return error;
    }
    return Error("no error");
}

TEST(Errors, NameSettingsAsTheFrontEndWritesThem) {
    const Error error = caught([] { fail("use {} draws, or {} compute: {}", setting::routing, setting::builder, 7); });
    EXPECT_STREQ(error.what(), "use routing draws, or builder compute: 7");
    EXPECT_EQ(error.line("--"), "use --routing draws, or --builder compute: 7");
    EXPECT_EQ(error.settings(), (std::vector<std::string>{"routing", "builder"}));
}

TEST(Errors, NameEachSettingOnce) {
    const Error error = caught([] { fail("{} voxel, not {} mipmap", setting::traversal, setting::traversal); });
    EXPECT_EQ(error.settings(), std::vector<std::string>{"traversal"});
}

TEST(Errors, KeepTheirSettingsWithinAnother) {
    const Error inner = caught([] { fail("out of range ({})", setting::ldc); });
    const Error outer = caught([&] { fail("frame {}: {}", 3, inner.text()); });
    EXPECT_EQ(outer.line("--"), "frame 3: out of range (--ldc)");
    EXPECT_EQ(outer.settings(), std::vector<std::string>{"ldc"});
}

TEST(Errors, NameNoSettingWhereNoneIsAtFault) {
    const Error error = caught([] { fail("cannot read '{}'", "a.obj"); });
    EXPECT_TRUE(error.settings().empty());
    EXPECT_EQ(error.line("--"), "cannot read 'a.obj'");
}

TEST(Errors, TakeTextThatLooksLikeAMark) {
    const Error error(
        "a\x0e"
        "b");
    EXPECT_TRUE(error.settings().empty());
    EXPECT_STREQ(error.what(), "ab");
}

}  // namespace
}  // namespace peelray
