// The table of settings itself, without starting the program.
#include <gtest/gtest.h>

#include <functional>

#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "cli/arguments.h"

namespace peelray {
namespace {

/// The options of a command, by its name, and the values that they are for.
struct Table {
    RenderArguments render;
    CompareArguments compare;
    TraceArguments trace;
    BenchArguments bench;
    std::vector<std::pair<std::string, SettingList>> lists = {{"render", options_of(render)},
                                                              {"compare", options_of(compare)},
                                                              {"trace", options_of(trace)},
                                                              {"bench", options_of(bench)}};
};

TEST(SettingsTable, NamesEachSettingOnceAndExplainsIt) {
    const Table table;
    for (const auto& [command, list] : table.lists) {
        std::set<std::string> names;
        for (const SettingEntry& entry : list) {
            SCOPED_TRACE(command + " " + entry.info.name);
            EXPECT_TRUE(names.insert(entry.info.name).second);
            EXPECT_FALSE(entry.info.help.empty());
            // What a value looks like, before and after it was typed.
            EXPECT_EQ(entry.info.form.empty(), entry.is_flag);
            for (const std::string& other : entry.info.excludes) EXPECT_TRUE(find_setting(list, other)) << other;
            EXPECT_TRUE(entry.info.needs.empty() || find_setting(list, entry.info.needs));
        }
    }
}

TEST(SettingsTable, DefaultsAreAllowedAndReadAsTheyAreWritten) {
    const Table table;
    for (const auto& [command, list] : table.lists)
        for (const SettingEntry& entry : list) {
            SCOPED_TRACE(command + " " + entry.info.name);
            EXPECT_NO_THROW(entry.check());
            if (const auto text = entry.text()) {
                EXPECT_TRUE(entry.set(*text)) << *text;
                EXPECT_EQ(entry.text(), text);
            }
        }
}

TEST(SettingsTable, KnowsEverySettingThatErrorsName) {
    std::ifstream stream(PEELRAY_SETTING_NAMES);
    const std::string header(std::istreambuf_iterator<char>(stream), {});
    const std::string part = header.substr(header.find("namespace setting {"), header.find("}  // namespace setting"));
    const std::regex constant(R"re((\w+)\{"([\w-]+)"\})re");
    Table table;
    size_t found = 0;
    for (auto at = std::sregex_iterator(part.begin(), part.end(), constant); at != std::sregex_iterator(); ++at) {
        const std::string name = (*at)[2];
        EXPECT_TRUE(find_setting(options_of(table.render), name)) << name;
        EXPECT_EQ((*at)[1], std::regex_replace(name, std::regex("-"), "_"));
        found++;
    }
    EXPECT_GT(found, 20u);
}

/// Text that the setting takes, too small and too large.
std::vector<std::string> beyond(const Limits& limits) {
    std::vector<std::string> texts;
    const double step = limits.open ? 0 : 1;
    if (std::isfinite(limits.least)) texts.push_back(fmt::format("{}", limits.least - step));
    if (std::isfinite(limits.most)) texts.push_back(fmt::format("{}", limits.most + step));
    return texts;
}

TEST(SettingsTable, LimitsRefuseWhatLiesBeyondNamingTheSetting) {
    Table table;
    size_t refused = 0;
    for (const auto& [command, list] : table.lists)
        for (const SettingEntry& entry : list)
            for (const std::string& number : beyond(entry.info.limits)) {
                SCOPED_TRACE(command + " " + entry.info.name + " " + number);
                // One number, or as many as a size or a vector has; less than nothing cannot be typed.
                const bool taken = entry.set(number) || entry.set(number + "x" + number) ||
                                   entry.set(fmt::format("{0},{0},{0}", number));
                if (!taken) {
                    EXPECT_LT(std::stod(number), 0);
                    continue;
                }
                try {
                    entry.check();
                    ADD_FAILURE() << "allowed";
                } catch (const Error& error) {
                    EXPECT_EQ(error.settings(), std::vector<std::string>{entry.info.name});
                    EXPECT_NE(error.line("--").find("--" + entry.info.name), std::string::npos) << error.line("--");
                    EXPECT_NE(error.line("--").find(entry.info.limits.choose), std::string::npos);
                }
                refused++;
            }
    EXPECT_GT(refused, 30u);
}

TEST(SettingsTable, TextOfAnotherFormChangesNothing) {
    Table table;
    for (const auto& [command, list] : table.lists)
        for (const SettingEntry& entry : list) {
            // Names of files, cameras, scenes and the like may be anything.
            if (entry.is_flag || entry.info.expected.empty() || entry.info.name == "scenes") continue;
            SCOPED_TRACE(command + " " + entry.info.name);
            const auto before = entry.text();
            for (const char* text : {"", "?", "1,", ",", "auto,auto"}) EXPECT_FALSE(entry.set(text)) << text;
            EXPECT_EQ(entry.text(), before);
        }
}

TEST(SettingsTable, VectorsAreFinite) {
    RenderArguments a;
    for (const char* name : {"eye", "look", "up", "background"}) {
        const SettingList list = options_of(a);
        const SettingEntry& entry = *find_setting(list, name);
        ASSERT_TRUE(entry.set("1,nan,1"));
        EXPECT_THROW(entry.check(), Error) << name;
        ASSERT_TRUE(entry.set("1,inf,1"));
        EXPECT_THROW(entry.check(), Error) << name;
        ASSERT_TRUE(entry.set("1,0,1"));
        EXPECT_NO_THROW(entry.check()) << name;
    }
}

TEST(SettingsTable, OpenRangesLeaveTheirEndsOut) {
    RenderArguments a;
    const SettingList list = options_of(a);
    for (const auto& [name, text, allowed] :
         std::initializer_list<std::tuple<const char*, const char*, bool>>{{"fov", "0", false},
                                                                           {"fov", "180", false},
                                                                           {"fov", "179", true},
                                                                           {"tolerance", "0", false},
                                                                           {"tolerance", "inf", false},
                                                                           {"tolerance", "nan", false},
                                                                           {"tolerance", "1e-9", true},
                                                                           {"depth", "16", true},
                                                                           {"depth", "32", true},
                                                                           {"depth", "24", false},
                                                                           {"exposure", "64", true},
                                                                           {"exposure", "nan", false},
                                                                           {"time", "1000000", true},
                                                                           {"time", "-0.5", false}}) {
        const SettingEntry& entry = *find_setting(list, name);
        ASSERT_TRUE(entry.set(text));
        if (allowed)
            EXPECT_NO_THROW(entry.check()) << name << text;
        else
            EXPECT_THROW(entry.check(), Error) << name << text;
    }
}

TEST(SettingsTable, AutoIsNoValue) {
    RenderArguments a;
    const SettingList list = options_of(a);
    for (const char* name : {"hit", "builder", "ldc"}) ASSERT_TRUE(find_setting(list, name)->set("auto")) << name;
    EXPECT_FALSE(a.tracing.hit || a.tracing.builder || a.tracing.ldc);
    ASSERT_TRUE(find_setting(list, "hit")->set("planar"));
    ASSERT_TRUE(find_setting(list, "ldc")->set("128"));
    EXPECT_EQ(a.tracing.hit, HitTest::planar);
    EXPECT_EQ(a.tracing.ldc, 128u);
}

/// The line of an Error for these settings; empty: they go together.
std::string refusal(const std::function<void(TracingArguments&)>& change) {
    TracingArguments a;
    change(a);
    try {
        check(a);
        return "";
    } catch (const Error& error) {
        return error.line("--");
    }
}

TEST(SettingsTable, WhatDoesNotGoTogetherIsRefused) {
    EXPECT_EQ(refusal([](auto&) {}), "");
    const auto peel = refusal([](auto& a) { a.builder = BuilderKind::peel, a.hit = HitTest::exact; });
    EXPECT_NE(peel.find("--builder peel captures pixel centres"), std::string::npos) << peel;
    EXPECT_EQ(refusal([](auto& a) { a.builder = BuilderKind::peel; }), "");
    const auto batch = refusal([](auto& a) { a.batch = Batch::rays; });
    EXPECT_NE(batch.find("use --batch rays with --traversal two-level or mipmap"), std::string::npos) << batch;
    const auto depth = refusal([](auto& a) { a.depth = 16; });
    EXPECT_NE(depth.find("--traversal voxel has a depth format of its own"), std::string::npos) << depth;
    const auto coarse = refusal([](auto& a) { a.depth = 16, a.traversal = Traversal::mipmap; });
    EXPECT_NE(coarse.find("too coarse for --hit auto"), std::string::npos) << coarse;
    const auto half = [](auto& a) { a.depth = 16, a.traversal = Traversal::mipmap, a.hit = HitTest::planar; };
    EXPECT_EQ(refusal(half), "");
}

}  // namespace
}  // namespace peelray
