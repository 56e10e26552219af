// Writes a report of small pictures with known colours and numbers, for report_browser_test.py.
#include <cstdio>

#include "base/error.h"
#include "base/infinity.h"
#include "image/report.h"

namespace peelray {
namespace {

constexpr uint32_t width = 60, height = 40;

uint32_t rgb(uint32_t r, uint32_t g, uint32_t b) {
    return r | g << 8 | b << 16 | 0xff000000u;
}

/// One colour; in the middle eight columns in turn black and white, where blurred pixels would be seen.
Image8 plain(uint32_t color) {
    Image8 image{width, height, std::vector<uint32_t>(width * height, color)};
    for (uint32_t y = height / 2 - 4; y < height / 2 + 4; ++y)
        for (uint32_t x = width / 2 - 4; x < width / 2 + 4; ++x)
            image.pixels[y * width + x] = x % 2 ? rgb(255, 255, 255) : rgb(0, 0, 0);
    return image;
}

Difference difference(double psnr, double others, float map) {
    return {psnr, 1 - others, others, others / 2, others / 4, {width, height, std::vector<float>(width * height, map)}};
}

Report sample() {
    const Image8 red = plain(rgb(200, 30, 20)), blue = plain(rgb(20, 40, 200));
    Report report;
    report.title = "Ünïcode </script><script>fail()</script> & \"quotes\" {{title}}";
    report.facts = {{"triangles", "56 066"}, {"device", "none <b>"}};
    report.notes = {"A note with <i>no</i> markup.", "A second note."};
    report.pictures = {{"reference", "sample --tracer reference", blue, {{"time", "9 s"}}, std::nullopt},
                       {"red",
                        "sample --tracer 'red' <&>",
                        red,
                        {{"time", "1 s"}, {"memory", "2 MiB"}},
                        difference(12.345, 0.25, 0.5f)},
                       {"equal", "", blue, {{"rays", "7"}}, difference(infinity, 0, 0)}};
    report.command = "sample all";
    return report;
}

}  // namespace
}  // namespace peelray

int main(int count, char** arguments) {
    if (count != 2) return std::fprintf(stderr, "sample_report PATH: writes a report there\n"), 2;
    try {
        peelray::write_report(arguments[1], peelray::sample());
    } catch (const peelray::Error& error) {
        std::fprintf(stderr, "sample_report: %s\n", error.what());
        return 1;
    }
}
