// `peelray doctor`, on this machine and on one that is made to lack something.
#include "cli/program_fixture.h"

namespace peelray {
namespace {

using nlohmann::json;

class DoctorCommand : public ProgramTest {
  protected:
    /// Where a Vulkan loader ought to be, and is none.
    std::string broken_libraries() const {
        std::filesystem::create_directory(folder / "lib");
        put("lib/libvulkan.so.1", "no library");
        put("lib/libvulkan.so", "no library");
        return folder / "lib";
    }
    static std::vector<std::string> causes(const json& report) {
        std::vector<std::string> names;
        for (const json& finding : report["findings"]) names.push_back(finding["cause"]);
        return names;
    }
};

TEST_F(DoctorCommand, AVulkanDevicePasses) {
    const Outcome run = this->run({"doctor", "--json"});
    EXPECT_EQ(run.status, 0) << run.err << run.out;
    EXPECT_EQ(run.err, "");
    const json report = json::parse(run.out);
    EXPECT_EQ(report["status"], 0);
    EXPECT_EQ(report["ldc"], true);
    EXPECT_EQ(report["cpu"], true);
    EXPECT_TRUE(report["khr"].is_boolean());
    EXPECT_EQ(report["causes"]["ldc"], nullptr);
    EXPECT_EQ(report["causes"]["cpu"], nullptr);
    EXPECT_EQ(report["causes"]["khr"].is_string(), !report["khr"].get<bool>());
    EXPECT_GT(report["frames"]["ldc"]["frame_ms"], 0);
    EXPECT_LT(report["frames"]["ldc"]["share_different"], 0.01);
    ASSERT_FALSE(report["devices"].empty());
    EXPECT_EQ(report["devices"][0]["lacks"], nullptr);
}

TEST_F(DoctorCommand, WithoutDriverFileCacheAndFfmpeg) {
    std::filesystem::create_directory(folder / "none");
    put("file", "");
    const std::map<std::string, std::string> variables = {
        {"VK_DRIVER_FILES", in("none")}, {"XDG_CACHE_HOME", in("file")}, {"PATH", in("none")}};
    const Outcome run = this->run({"doctor", "--json"}, variables);
    EXPECT_EQ(run.status, 1) << run.err;
    const json report = json::parse(run.out);
    EXPECT_EQ(report["status"], 1);
    EXPECT_EQ(report["ldc"], false);
    EXPECT_EQ(report["khr"], false);
    EXPECT_EQ(report["cpu"], true);
    EXPECT_EQ(causes(report), (std::vector<std::string>{"no-driver-file", "cache", "no-ffmpeg"}));
    for (const char* tracer : {"ldc", "khr"})
        EXPECT_NE(report["causes"][tracer].get<std::string>().find(in("none")), std::string::npos);
    EXPECT_TRUE(report["devices"].empty());
    // For people: a line each.
    const Outcome text = this->run({"doctor"}, variables);
    EXPECT_EQ(text.status, 1);
    EXPECT_EQ(std::count(text.out.begin(), text.out.end(), '\n'), 7) << text.out;
    for (const char* part : {"cpu       works: a checked frame of 96x72 in ",
                             "no-driver-file: ", "\ncache: nothing can be", "no-ffmpeg: there is no ffmpeg"})
        EXPECT_NE(text.out.find(part), std::string::npos) << text.out;
}

TEST_F(DoctorCommand, WithoutALoader) {
    const Outcome run = this->run({"doctor"}, {{"LD_LIBRARY_PATH", broken_libraries()}});
    EXPECT_EQ(run.status, 1) << run.err;
    EXPECT_NE(run.out.find("no-loader: Vulkan's loader, libvulkan.so.1, is not installed: install it"),
              std::string::npos)
        << run.out;
    EXPECT_NE(run.out.find("ldc       does not work: Vulkan's loader"), std::string::npos) << run.out;
}

TEST_F(DoctorCommand, Usage) {
    expect_refused(run({"doctor", "scene.glb"}), 2, "one argument too many");
    const Outcome help = run({"doctor", "--help"});
    EXPECT_EQ(help.status, 0);
    for (const char* part : {"--json", "One line per cause", "Exit status 0"})
        EXPECT_NE(help.out.find(part), std::string::npos) << help.out;
}

}  // namespace
}  // namespace peelray
