// Fills report.html: everything that can be read without JavaScript is written here; the page's script only adds the
// viewer on top of the pictures that already stand in the page.
#include "image/report.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <string_view>

#include "base/error.h"
#include "base/infinity.h"
#include "image/codecs.h"

namespace peelray {

/// The bytes of report.html, generated at build time.
std::string_view report_template();

namespace {

/// Text for HTML, in an element or a quoted attribute. Control characters are not allowed in HTML at all.
std::string html_text(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else if (c == '\'')
            out += "&#39;";
        else if (uint8_t(c) < 0x20 && c != '\n' && c != '\t')
            out += "\uFFFD";
        else
            out += c;
    }
    return out;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t at = 0; at < bytes.size(); at += 3) {
        const size_t count = std::min<size_t>(3, bytes.size() - at);
        uint32_t group = 0;
        for (size_t i = 0; i < 3; ++i) group = group << 8 | (i < count ? uint8_t(bytes[at + i]) : 0u);
        for (size_t i = 0; i < 4; ++i) out += i <= count ? digits[group >> (18 - 6 * i) & 63] : '=';
    }
    return out;
}

/// One number of a Difference as the table shows it.
struct Metric {
    std::string_view label, meaning;
    double Difference::*value;
    int digits;
    double perfect;
    bool higher_is_better = false;
    double scale = 1;
    std::string_view unit = "";
};
constexpr std::array metrics = {
    Metric{"PSNR", "peak signal-to-noise ratio; higher is better, ∞: equal", &Difference::psnr, 2, infinity, true, 1,
           " dB"},
    Metric{"SSIM", "structural similarity; higher is better, 1: equal", &Difference::ssim, 4, 1, true},
    Metric{"FLIP", "mean difference that an observer sees, 0 to 1; lower is better", &Difference::flip, 4, 0},
    Metric{"HDR-FLIP", "the same over all exposures of the radiance; lower is better, –: a picture without radiance",
           &Difference::hdr_flip, 4, 0},
    Metric{"pixels different", "share of the pixels that differ by more than 1/255 in a channel; lower is better",
           &Difference::different, 2, 0, false, 100, " %"},
};

/// Never rounds to the perfect value what is not perfect: a reader must not take "nearly equal" for "equal".
std::string number(const Metric& metric, const Difference& difference) {
    const double value = difference.*metric.value * metric.scale;
    if (std::isnan(value)) return "–";
    if (std::isinf(value)) return value > 0 ? "∞" : "−∞";
    const auto rounded = [&](double v) { return fmt::format("{:.{}f}", v, metric.digits); };
    const double step = std::pow(10.0, -metric.digits);
    std::string text = rounded(value);
    if (value > metric.perfect && text == rounded(metric.perfect)) text = "&lt; " + rounded(metric.perfect + step);
    if (value < metric.perfect && text == rounded(metric.perfect)) text = "&gt; " + rounded(metric.perfect - step);
    return fmt::format("{}{}", text, metric.unit);
}

using Pictures = std::vector<ReportPicture>;

/// The best value of a metric among several pictures; NaN, which no value equals, if all are the same or there is one.
double best_value(const Metric& metric, const Pictures& pictures, size_t reference) {
    double lowest = infinity, highest = -infinity;
    for (size_t i = 0; i < pictures.size(); ++i) {
        if (i == reference || !pictures[i].difference) continue;
        lowest = std::min(lowest, (*pictures[i].difference).*metric.value);
        highest = std::max(highest, (*pictures[i].difference).*metric.value);
    }
    if (!(lowest < highest)) return std::numeric_limits<double>::quiet_NaN();
    return metric.higher_is_better ? highest : lowest;
}

std::string metric_table(const Pictures& pictures, size_t reference) {
    if (pictures.size() < 2) return "";
    std::string head, rows;
    for (const Metric& metric : metrics)
        head +=
            fmt::format("<th scope=\"col\" title=\"{}\">{} <span class=\"better\" aria-hidden=\"true\">{}</span></th>",
                        metric.meaning, metric.label, metric.higher_is_better ? "↑" : "↓");
    for (size_t i = 0; i < pictures.size(); ++i) {
        if (i == reference) continue;
        rows += fmt::format("<tr><th scope=\"row\">{}</th>", html_text(pictures[i].name));
        for (const Metric& metric : metrics) {
            const std::optional<Difference>& difference = pictures[i].difference;
            const bool best = difference && (*difference).*metric.value == best_value(metric, pictures, reference);
            rows += fmt::format("<td{}>{}</td>", best ? " class=\"best\"" : "",
                                difference ? number(metric, *difference) : "–");
        }
        rows += "</tr>\n";
    }
    std::string meanings;
    for (const Metric& metric : metrics)
        meanings += fmt::format("<dt>{}</dt><dd>{}</dd>", metric.label, metric.meaning);
    return fmt::format(
        "<section><h2>Difference from {}</h2>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
        "aria-label=\"Metrics\">"
        "<table id=\"metrics\"><thead><tr><th "
        "scope=\"col\">Picture</th>{}</tr></thead>\n<tbody>{}</tbody></table></div>\n"
        "<details><summary>What the numbers mean</summary><dl class=\"meanings\">{}</dl>{}</details></section>",
        html_text(pictures[reference].name), head, rows, meanings,
        pictures.size() > 2 ? "<p>Bold: the best of the pictures.</p>" : "");
}

/// One row per fact, in the order of first appearance; one column per picture.
std::string facts_table(const Pictures& pictures) {
    std::vector<std::string_view> labels;
    for (const ReportPicture& picture : pictures)
        for (const auto& [label, value] : picture.facts)
            if (std::find(labels.begin(), labels.end(), label) == labels.end()) labels.push_back(label);
    if (labels.empty()) return "";
    std::string head, rows;
    for (const ReportPicture& picture : pictures)
        head += fmt::format("<th scope=\"col\">{}</th>", html_text(picture.name));
    for (const std::string_view label : labels) {
        rows += fmt::format("<tr><th scope=\"row\">{}</th>", html_text(label));
        for (const ReportPicture& picture : pictures) {
            const auto fact = std::find_if(picture.facts.begin(), picture.facts.end(),
                                           [&](const ReportFact& f) { return f.first == label; });
            rows += fmt::format("<td>{}</td>", fact == picture.facts.end() ? "–" : html_text(fact->second));
        }
        rows += "</tr>\n";
    }
    return fmt::format(
        "<section><h2>How each picture was made</h2>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
        "aria-label=\"Facts of each picture\"><table id=\"made\"><thead><tr><td></td>{}</tr></thead>\n"
        "<tbody>{}</tbody></table></div></section>",
        head, rows);
}

/// A command whose words stand in one element each.
std::string words(std::string_view command) {
    std::string out;
    for (;;) {
        const size_t space = command.find(' ');
        const std::string_view word = command.substr(0, space);
        if (!word.empty()) out += fmt::format("<span>{}</span>", html_text(word));
        if (space == std::string_view::npos) return out;
        out += ' ';
        command.remove_prefix(space + 1);
    }
}

std::string command_list(const Report& report) {
    std::string items;
    const auto add = [&](std::string_view name, std::string_view command) {
        if (command.empty()) return;
        items += fmt::format(
            "<li><span class=\"name\">{0}</span><div class=\"command\"><code>{1}</code><button type=\"button\" "
            "class=\"copy js\" aria-label=\"Copy the command of {0}\">Copy</button></div></li>\n",
            html_text(name), words(command));
    };
    for (const ReportPicture& picture : report.pictures) add(picture.name, picture.command);
    add("this report", report.command);
    if (items.empty()) return "";
    return fmt::format("<section><h2>Commands</h2>\n<ul class=\"commands\">{}</ul></section>", items);
}

std::string fact_list(const std::vector<ReportFact>& facts) {
    std::string items;
    for (const auto& [label, value] : facts)
        items += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", html_text(label), html_text(value));
    return items.empty() ? "" : fmt::format("<dl class=\"facts\">{}</dl>", items);
}

std::string note_list(const std::vector<std::string>& notes) {
    std::string items;
    for (const std::string& note : notes) items += fmt::format("<li>{}</li>", html_text(note));
    return items.empty() ? "" : fmt::format("<ul class=\"notes\" aria-label=\"Notes\">{}</ul>", items);
}

std::string data_uri(const std::filesystem::path& path, const Image8& image) {
    return "data:image/png;base64," + base64(encode_png(path, image));
}

std::string figure(const std::filesystem::path& path, std::string_view kind, const std::string& name,
                   const Image8& image) {
    return fmt::format(
        "<li><figure data-kind=\"{}\"><img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"{}\"><figcaption>{}</figcaption>"
        "</figure></li>\n",
        kind, image.width, image.height, html_text(name), data_uri(path, image), html_text(name));
}

/// The difference whose map is shown beside a picture, if any.
const Difference* mapped(const Report& report, size_t index) {
    const std::optional<Difference>& difference = report.pictures[index].difference;
    return index != report.reference && difference && !difference->map.values.empty() ? &*difference : nullptr;
}

std::string figures(const std::filesystem::path& path, const Report& report) {
    std::string out;
    for (size_t i = 0; i < report.pictures.size(); ++i) {
        const ReportPicture& picture = report.pictures[i];
        out += figure(path, i == report.reference ? "reference" : "picture", picture.name, picture.picture);
    }
    for (size_t i = 0; i < report.pictures.size(); ++i)
        if (const Difference* difference = mapped(report, i))
            out += figure(path, "map", "FLIP: " + report.pictures[i].name, colorize(difference->map));
    return out;
}

/// The colours of the error maps from 0 to 1, one pixel per step; the page reads values back with it.
std::string legend(const std::filesystem::path& path, const Report& report) {
    bool any = false;
    for (size_t i = 0; i < report.pictures.size(); ++i) any = any || mapped(report, i);
    if (!any) return "";
    ErrorMap ramp{256, 1, {}};
    for (int i = 0; i < 256; ++i) ramp.values.push_back(float(i) / 255);
    return fmt::format(
        "<div class=\"legend\"><span>FLIP 0</span><img id=\"legend\" width=\"256\" height=\"1\" alt=\"colours of the "
        "error "
        "maps, black to light yellow\" src=\"{}\"><span>1</span></div>",
        data_uri(path, colorize(ramp)));
}

/// One pass, so that no text of the report is taken for a placeholder.
std::string filled(std::string_view text, const std::map<std::string_view, std::string>& values) {
    std::string out;
    for (size_t open; (open = text.find("{{")) != std::string_view::npos;) {
        const size_t close = text.find("}}", open);
        assert(close != std::string_view::npos);
        out += text.substr(0, open);
        out += values.at(text.substr(open + 2, close - open - 2));
        text.remove_prefix(close + 2);
    }
    return out.append(text);
}

void check(const std::filesystem::path& path, const Report& report) {
    if (report.pictures.empty()) fail("cannot write {}: a report needs at least one picture", path.string());
    if (report.reference >= report.pictures.size())
        fail("cannot write {}: picture {} is to be the reference, but there are {} (counted from 0)", path.string(),
             report.reference, report.pictures.size());
    const Image8& reference = report.pictures[report.reference].picture;
    for (size_t i = 0; i < report.pictures.size(); ++i) {
        const auto same = [&](std::string_view what, uint32_t width, uint32_t height) {
            if (width != reference.width || height != reference.height)
                fail(
                    "cannot write {}: the {} {} has {} x {} pixels, the reference {} x {}; compare pictures of one "
                    "size",
                    path.string(), what, report.pictures[i].name, width, height, reference.width, reference.height);
        };
        same("picture", report.pictures[i].picture.width, report.pictures[i].picture.height);
        if (const Difference* difference = mapped(report, i))
            same("error map of", difference->map.width, difference->map.height);
    }
}

}  // namespace

void write_report(const std::filesystem::path& path, const Report& report) {
    check(path, report);
    check_writable(path);  // before the pictures are compressed
    const Image8& reference = report.pictures[report.reference].picture;
    store_file(path, filled(report_template(), {{"title", html_text(report.title)},
                                                {"facts", fact_list(report.facts)},
                                                {"notes", note_list(report.notes)},
                                                {"width", std::to_string(reference.width)},
                                                {"height", std::to_string(reference.height)},
                                                {"pictures", figures(path, report)},
                                                {"legend", legend(path, report)},
                                                {"metrics", metric_table(report.pictures, report.reference)},
                                                {"made", facts_table(report.pictures)},
                                                {"commands", command_list(report)}}));
}

}  // namespace peelray
