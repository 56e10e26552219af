// The report as bytes; what a browser makes of it is tested in tests/report.
#include "image/report.h"
#include "base/infinity.h"

#include <cmath>

#include "temp_folder.h"

namespace peelray {
namespace {

using ReportFile = TempFolder;

Image8 noise(uint32_t width, uint32_t height, uint32_t seed) {
    Image8 image{width, height, {}};
    for (uint32_t i = 0; i < width * height; ++i) image.pixels.push_back((i + seed) * 2654435761u | 0xff000000u);
    return image;
}

ErrorMap ramp(uint32_t width, uint32_t height) {
    ErrorMap map{width, height, {}};
    for (uint32_t i = 0; i < width * height; ++i) map.values.push_back(float(i) / float(width * height));
    return map;
}

Report small_report(uint32_t width = 7, uint32_t height = 5) {
    Report report;
    report.title = "a scene";
    report.pictures = {{"first",
                        "make first",
                        noise(width, height, 1),
                        {{"time", "1 s"}},
                        Difference{30, 0.9, 0.1, 0.2, 0.5, ramp(width, height)}},
                       {"reference", "make reference", noise(width, height, 2), {{"rays", "9"}}, std::nullopt}};
    report.reference = 1;
    return report;
}

std::string base64_decoded(std::string_view text) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    uint32_t bits = 0, count = 0;
    EXPECT_EQ(text.size() % 4, 0u);
    while (text.ends_with('=')) text.remove_suffix(1);
    for (const char c : text) {
        EXPECT_NE(digits.find(c), std::string_view::npos) << c;
        bits = bits << 6 | uint32_t(digits.find(c));
        if ((count += 6) >= 8) out += char(bits >> (count -= 8) & 0xff);
    }
    return out;
}

size_t occurrences(std::string_view text, std::string_view part) {
    size_t count = 0;
    for (size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

class Html : public TempFolder {
  protected:
    std::string written(const Report& report) const {
        write_report(folder / "report.html", report);
        return get(folder / "report.html");
    }
    /// The pictures in the order of the file.
    std::vector<Image8> decoded(std::string_view html) const {
        constexpr std::string_view start = "src=\"data:image/png;base64,";
        std::vector<Image8> images;
        for (size_t at = html.find(start); at != std::string_view::npos; at = html.find(start, at)) {
            at += start.size();
            images.push_back(read_ldr(put("picture.png", base64_decoded(html.substr(at, html.find('"', at) - at)))));
        }
        return images;
    }
    /// The cells of the metric table when the difference is this one.
    std::string cells(const Difference& difference) const {
        Report report = small_report();
        report.pictures[0].difference = difference;
        const std::string html = written(report);
        const size_t start = html.find("<th scope=\"row\">first</th>");
        return html.substr(start + 26, html.find("</tr>", start) - start - 26);
    }
};

TEST_F(Html, HoldsThePicturesPixelByPixel) {
    for (const auto& [width, height] : {std::pair{7u, 5u}, {1u, 1u}, {64u, 3u}, {5u, 8u}}) {
        const Report report = small_report(width, height);
        const std::vector<Image8> images = decoded(written(report));
        ASSERT_EQ(images.size(), 4u);  // the legend, two pictures, an error map
        EXPECT_EQ(images[0].width, 256u);
        EXPECT_EQ(images[0].pixels.front(), colorize({1, 1, {0}}).pixels[0]);
        EXPECT_EQ(images[0].pixels.back(), colorize({1, 1, {1}}).pixels[0]);
        for (size_t i = 0; i < 2; ++i) EXPECT_EQ(images[i + 1].pixels, report.pictures[i].picture.pixels);
        EXPECT_EQ(images[3].pixels, colorize(ramp(width, height)).pixels);
        EXPECT_EQ(images[3].width, width);
    }
}

TEST_F(Html, EscapesEveryText) {
    const std::string nasty = "<b>\"x\" & 'y'</script>\x01 é {{pictures}}";
    Report report = small_report();
    report.title = report.command = report.pictures[0].name = report.pictures[0].command = nasty;
    report.pictures[1].name = nasty;
    report.notes = {nasty};
    report.facts = report.pictures[0].facts = {{nasty, nasty}};
    const std::string html = written(report);
    EXPECT_EQ(occurrences(html, "<b>"), 0u);
    EXPECT_EQ(occurrences(html, "'y'"), 0u);
    EXPECT_EQ(occurrences(html, "\x01"), 0u);
    EXPECT_EQ(occurrences(html, "</script>"), 2u);  // the page's own
    EXPECT_EQ(decoded(html).size(), 4u);
    const std::string escaped = "&lt;b&gt;&quot;x&quot; &amp; &#39;y&#39;&lt;/script&gt;\uFFFD é {{pictures}}";
    EXPECT_NE(html.find("<title>" + escaped + " "), std::string::npos);
    EXPECT_NE(html.find("<h1>" + escaped + "</h1>"), std::string::npos);
    EXPECT_NE(html.find("<li>" + escaped + "</li>"), std::string::npos);
    EXPECT_NE(html.find("<dt>" + escaped + "</dt><dd>" + escaped + "</dd>"), std::string::npos);
    EXPECT_NE(html.find("alt=\"" + escaped + "\""), std::string::npos);
    EXPECT_NE(html.find("<figcaption>FLIP: " + escaped + "</figcaption>"), std::string::npos);
}

TEST_F(Html, RefersToNothingOutside) {
    const std::string html = written(small_report());
    for (const char* part : {"http:", "https:", "url(", "@import", "fetch(", "XMLHttpRequest", "import(", "WebSocket"})
        EXPECT_EQ(occurrences(html, part), 0u) << part;
    EXPECT_EQ(occurrences(html, " src="), occurrences(html, " src=\"data:image/png;base64,"));
    EXPECT_EQ(occurrences(html, " href="), occurrences(html, " href=\"data:,\""));
    EXPECT_EQ(occurrences(html, "default-src 'none'"), 1u);
}

TEST_F(Html, NeverRoundsToEqualWhatIsNot) {
    const ErrorMap map = ramp(7, 5);
    EXPECT_EQ(cells({30, 0.9, 0.1, 0.2, 0.5, map}),
              "<td>30.00 dB</td><td>0.9000</td><td>0.1000</td><td>0.2000</td><td>50.00 %</td>");
    EXPECT_EQ(cells({infinity, 1, 0, 0, 0, map}),
              "<td>∞</td><td>1.0000</td><td>0.0000</td><td>0.0000</td><td>0.00 %</td>");
    EXPECT_EQ(cells({99, 0.999999, 1e-6, 1e-9, 1e-7, map}),
              "<td>99.00 dB</td><td>&gt; 0.9999</td><td>&lt; 0.0001</td><td>&lt; 0.0001</td><td>&lt; 0.01 %</td>");
    EXPECT_EQ(cells({NAN, -1, 0, 0, 0, map}).substr(0, 38), "<td>–</td><td>-1.0000</td><td>0.0000");
}

TEST_F(Html, MarksTheBestOfSeveral) {
    Report report = small_report();
    report.pictures.push_back(report.pictures[0]);
    EXPECT_EQ(occurrences(written(report), "class=\"best\""), 0u);
    report.pictures[2].difference->psnr = 31;   // better
    report.pictures[2].difference->flip = 0.2;  // worse
    const std::string html = written(report);
    EXPECT_EQ(occurrences(html, "class=\"best\""), 2u);
    EXPECT_EQ(occurrences(html, "<td class=\"best\">31.00 dB</td>"), 1u);
    EXPECT_EQ(occurrences(html, "<td class=\"best\">0.1000</td>"), 1u);
}

TEST_F(Html, LeavesOutWhatThereIsNot) {
    Report report = small_report();
    report.pictures[0].difference.reset();
    std::string html = written(report);
    EXPECT_EQ(decoded(html).size(), 2u);
    EXPECT_EQ(occurrences(html, "<td>–</td><td>–</td><td>–</td><td>–</td><td>–</td>"), 1u);
    report.pictures.resize(1);
    report.pictures[0].command.clear();
    report.reference = 0;
    html = written(report);
    for (const char* part :
         {"id=\"metrics\"", "id=\"legend\"", "class=\"commands\"", "class=\"notes\"", "class=\"facts\""})
        EXPECT_EQ(occurrences(html, part), 0u) << part;
}

TEST_F(ReportFile, RefusesWhatIsNoComparison) {
    const std::filesystem::path path = put("old.html", "old");
    Report report = small_report();
    report.pictures[0].picture = noise(7, 6, 1);
    expect_error([&] { write_report(path, report); }, "first has 7 x 6 pixels, the reference 7 x 5");
    report = small_report();
    report.pictures[0].difference->map = ramp(6, 5);
    expect_error([&] { write_report(path, report); }, "error map of first has 6 x 5 pixels");
    report = small_report();
    report.reference = 2;
    expect_error([&] { write_report(path, report); }, "picture 2 is to be the reference, but there are 2");
    expect_error([&] { write_report(path, Report{}); }, "at least one picture");
    report = small_report();
    for (ReportPicture& picture : report.pictures) picture.picture = {};
    report.pictures[0].difference.reset();
    expect_error([&] { write_report(path, report); }, "0 x 0 pixels is empty");
    EXPECT_EQ(get(path), "old");
    EXPECT_EQ(files(), 1u);
}

TEST_F(ReportFile, SaysWhyAPlaceIsNotWritable) {
    expect_error([&] { write_report(folder, small_report()); }, "is a folder");
    expect_error([&] { write_report("/proc/no/report.html", small_report()); }, "/proc/no");
    expect_error([&] { write_report("/dev/null", small_report()); }, "not a regular file");
    EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace peelray
