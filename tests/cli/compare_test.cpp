// `peelray compare`: what it writes, that its commands make its pictures again, and what it refuses.
#include <signal.h>

#include "cli/program_fixture.h"
#include "image/metrics.h"

namespace peelray {
namespace {

using Words = std::vector<std::string>;

class CompareCommand : public ProgramTest {
  protected:
    Outcome compare(const std::string& scene, const Words& more = {}) const {
        Words arguments = {"compare", scene, "-o", out("r.html"), "--size", "64x48"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
    nlohmann::json json(const std::string& name = "r.json") const { return nlohmann::json::parse(get(out(name))); }
};

/// Columns `first` … of a strip's picture number `index`.
Image8 part_of(const Image8& strip, uint32_t index, uint32_t width = 64) {
    Image8 part{width, strip.height, {}};
    for (uint32_t y = 0; y < strip.height; y++)
        for (uint32_t x = 0; x < width; x++)
            part.pixels.push_back(strip.pixels[y * strip.width + index * (width + 8) + x]);
    return part;
}

TEST_F(CompareCommand, WritesReportNumbersAndPictures) {
    const Outcome run =
        compare("builtin:teapots", {"--json", out("r.json"), "--strip", out("s.png"), "--worst", out("w.png")});
    expect_done(run, {"r.html", "r.json", "s.png", "w.png"});
    const nlohmann::json j = json();
    EXPECT_EQ(j["reference"], "reference");
    EXPECT_EQ(j["triangles"], 56066);
    ASSERT_EQ(j["pictures"].size(), 3u);
    const std::string html = get(out("r.html"));
    const Image8 strip = read_ldr(out("s.png"));
    ASSERT_EQ(strip.width, 3 * 64u + 2 * 8u);
    const char* names[] = {"cubemap", "ldc", "reference"};
    for (uint32_t i = 0; i < 3; i++) {
        const auto& picture = j["pictures"][i];
        EXPECT_EQ(picture["name"], names[i]);
        EXPECT_EQ(picture["stats"]["tracer"], names[i]);
        EXPECT_EQ(picture.contains("difference"), i < 2);
        EXPECT_NE(html.find(names[i]), std::string::npos);
        if (i == 2) continue;
        // The numbers are those of the pictures.
        const Image8 ours = part_of(strip, i), reference = part_of(strip, 2);
        const auto& d = picture["difference"];
        EXPECT_NEAR(d["psnr_db"].get<double>(), psnr(reference, ours), 1e-9);
        EXPECT_NEAR(d["ssim"].get<double>(), ssim(reference, ours), 1e-9);
        EXPECT_NEAR(d["flip"].get<double>(), flip(reference, ours).mean(), 1e-9);
        EXPECT_EQ(d["share_different"].get<double>(), share_different(reference, ours));
        const ErrorMap map = flip(reference, ours);
        const size_t worst = d["worst_pixel"][1].get<size_t>() * 64 + d["worst_pixel"][0].get<size_t>();
        EXPECT_EQ(map.values[worst], *std::max_element(map.values.begin(), map.values.end()));
    }
    // The baseline is far off, the method is not: in this order, or something is the wrong way round.
    EXPECT_GT(j["pictures"][0]["difference"]["flip"], 0.05);
    EXPECT_LT(j["pictures"][1]["difference"]["flip"], 0.005);
    EXPECT_EQ(j["notes"].size(), 0u);
}

TEST_F(CompareCommand, ItsCommandsMakeItsPicturesAgain) {
    put("it's a cube.obj", kCube);
    expect_done(
        compare(in("it's a cube.obj"), {"--material", "mirror", "--floor", "--tracers", "none,cubemap,ldc,reference",
                                        "--hit", "exact,planar", "--bounces=2", "--eye", "3,2,4", "--exposure", "-1",
                                        "--repeat", "2", "--json", out("r.json"), "--strip", out("s.png")}),
        {"r.html", "r.json", "s.png"});
    const Image8 strip = read_ldr(out("s.png"));
    uint32_t index = 0;
    const nlohmann::json j = json();
    for (const auto& picture : j["pictures"]) {
        const std::string command = picture["command"];
        SCOPED_TRACE(command);
        ASSERT_TRUE(command.starts_with("peelray render "));
        const std::string shell = "cd '" + (folder / "scratch").string() +
                                  "' && XDG_CACHE_HOME='" PEELRAY_CACHE "' '" PEELRAY_PROGRAM "'" + command.substr(7) +
                                  " > /dev/null";
        ASSERT_EQ(std::system(shell.c_str()), 0);
        std::string name = picture["name"];
        std::replace(name.begin(), name.end(), ' ', '-');
        EXPECT_EQ(read_ldr(folder / "scratch" / (name + ".png")).pixels, part_of(strip, index++).pixels);
    }
    EXPECT_EQ(index, 5u);
}

TEST_F(CompareCommand, PicturesOfOtherPrograms) {
    put("cube.obj", kCube);
    expect_done(render(in("cube.obj"), {"--tracer", "ldc"}, "a.png"), {"a.png"});
    expect_done(render(in("cube.obj"), {"--tracer", "ldc"}, "a.exr"), {"a.exr", "a.png"});
    const Outcome run = compare(in("cube.obj"), {"--tracers", "ldc", "--picture", out("a.png"), "--picture",
                                                 out("a.exr"), "--json", out("r.json")});
    EXPECT_EQ(run.status, 0) << run.err;
    const nlohmann::json j = json();
    EXPECT_EQ(j["reference"], "ldc");
    EXPECT_EQ(j["notes"].size(), 2u) << j["notes"];  // nothing reflects, no reference
    ASSERT_EQ(j["pictures"].size(), 3u);
    EXPECT_EQ(j["pictures"][0]["name"], "a.png");
    EXPECT_EQ(j["pictures"][0]["difference"]["identical"], true);
    EXPECT_TRUE(j["pictures"][0]["difference"]["hdr_flip"].is_null());
    EXPECT_EQ(run.out.find("nan"), std::string::npos) << run.out;
    // Half floats round: the tone-mapped picture may differ by a step.
    EXPECT_EQ(j["pictures"][1]["difference"]["share_different"], 0);
    EXPECT_LT(j["pictures"][1]["difference"]["hdr_flip"], 0.02);
}

TEST_F(CompareCommand, OddNames) {
    put("cube.obj", kCube);
    std::filesystem::create_directories(folder / "a b");
    expect_done(render(in("cube.obj"), {}, "p.PNG"), {"p.PNG"});
    std::filesystem::copy_file(out("p.PNG"), folder / "a b/p.PNG");
    const std::string odd = in("\xff\xfe'<.obj");
    std::filesystem::copy_file(in("cube.obj"), odd);
    const Outcome run = compare(
        odd, {"--tracers", "none", "--picture", out("p.PNG"), "--picture", in("a b/p.PNG"), "--json", out("r.json")});
    EXPECT_EQ(run.status, 0) << run.err;
    const nlohmann::json j = json();
    ASSERT_EQ(j["pictures"].size(), 3u);
    EXPECT_EQ(j["pictures"][0]["name"], "p.PNG");
    EXPECT_EQ(j["pictures"][1]["name"], "p.PNG (2)");
    EXPECT_NE(j["command"].get<std::string>().find("--picture '" + in("a b/p.PNG") + "'"), std::string::npos)
        << j["command"];
    EXPECT_EQ(run.out.find("inf"), std::string::npos) << run.out;
}

TEST_F(CompareCommand, MemoryIsThePicturesOwn) {
    put("cube.obj", kCube);
    expect_done(compare(in("cube.obj"), {"--tracers", "ldc", "--json", out("a.json")}), {"a.json", "r.html"});
    expect_done(compare(in("cube.obj"), {"--tracers", "cubemap,none,ldc", "--json", out("b.json"), "--floor"}),
                {"a.json", "b.json", "r.html"});
    expect_done(compare(in("cube.obj"), {"--tracers", "ldc", "--json", out("a.json"), "--floor"}),
                {"a.json", "b.json", "r.html"});
    EXPECT_EQ(json("a.json")["pictures"][0]["stats"]["memory_bytes"],
              json("b.json")["pictures"][2]["stats"]["memory_bytes"]);
}

TEST_F(CompareCommand, SaysWhenNothingReflects) {
    put("cube.obj", kCube);
    const Outcome run = compare(in("cube.obj"), {"--tracers", "ldc,reference"});
    expect_done(run, {"r.html"});
    EXPECT_NE(run.err.find("peelray: note: nothing in this scene reflects or refracts"), std::string::npos) << run.err;
    EXPECT_NE(get(out("r.html")).find("nothing in this scene reflects or refracts"), std::string::npos);
}

TEST_F(CompareCommand, WrongUsageAndBadInput) {
    put("cube.obj", kCube);
    expect_refused(compare(in("cube.obj"), {"--tracers", "ldc,embree"}), 2,
                   "'ldc,embree' is not a list out of cubemap,ldc");
    expect_refused(compare(in("cube.obj"), {"--tracers", "ldc,ldc"}), 2, "each once");
    expect_refused(compare(in("cube.obj"), {"--tracers", ""}), 2, "--tracers");
    expect_refused(compare(in("cube.obj"), {"--hit", "exact,exact"}), 2, "each once");
    expect_refused(compare(in("cube.obj"), {"--tracer", "ldc"}), 2, "--tracer");
    expect_refused(compare(in("cube.obj"), {"--hit", "exact", "--builder", "peel"}), 1, "--builder peel captures");
    expect_refused(compare(in("no.obj")), 1, "no.obj");
    expect_refused(compare(in("cube.obj"), {"--picture", in("no.png")}), 1, "no.png");
    expect_refused(compare(in("cube.obj"), {"--strip", out("s.jpg")}), 1, "name it .png");
    expect_refused(compare(in("cube.obj"), {"--tracers", "none", "--hit", "exact", "--builder", "peel"}), 1,
                   "--builder peel captures");
    expect_refused(compare(in("cube.obj"), {"--tracers", "ldc", "--worst", out("w.png")}), 1, "two pictures");
    expect_refused(compare(in("cube.obj"), {"--json", out("r.html")}), 1, "written twice");
    expect_refused(run({"compare", in("cube.obj"), "-o", out("r.png")}), 1, "name '");
    expect_refused(run({"compare", in("cube.obj"), "-o", "/proc/r.html"}), 1, "/proc/r.html");
    write_png(folder / "small.png", Image8{2, 1, {0xff000000u, 0xffffffffu}});
    expect_refused(compare(in("cube.obj"), {"--picture", in("small.png")}), 1,
                   "small.png has 2x1 pixels, the others 64x48");
}

TEST_F(CompareCommand, AnInterruptLeavesNothing) {
    for (const Words& work :
         {Words{"compare", "builtin:glass", "-o", out("r.html"), "--json", out("r.json"), "--tracers", "reference"},
          Words{"render", "builtin:glass", "-o", out("r.png"), "--tracer", "reference"},
          Words{"render", "builtin:glass", "-o", out("r.png"), "--tracer", "ldc"}}) {
        SCOPED_TRACE(testing::PrintToString(work));
        Words arguments = work;
        arguments.insert(arguments.end(), {"--spp", "4096", "--size", "320x256"});
        // `timeout` sends the signal after a while, as a user's Ctrl-C would, and ends with the program's own status.
        std::string line = "XDG_CACHE_HOME='" PEELRAY_CACHE
                           "' timeout --foreground --preserve-status --signal=INT 2.5 '" PEELRAY_PROGRAM "'";
        for (const std::string& word : arguments) line += " '" + word + "'";
        line +=
            " > '" + (folder / "scratch/o").string() + "' 2> '" + (folder / "scratch/e").string() + "'; test $? -eq 1";
        EXPECT_EQ(std::system(line.c_str()), 0);
        EXPECT_EQ(get(folder / "scratch/e"), "peelray: interrupted: nothing was written; run it again\n");
        EXPECT_EQ(outputs(), Words());
    }
}

}  // namespace
}  // namespace peelray
