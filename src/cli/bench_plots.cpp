#include "cli/bench_plots.h"

#include <algorithm>

#include "cli/bench_output.h"
#include "image/line_chart.h"

namespace peelray {
namespace {

using Value = std::optional<double>;

bool is_blob(const RayRow& row) {
    return row.scene.find("blob:") != std::string::npos;
}

Value rate(const RayRow& row) {
    const TracedSet* mirror = row.set(RayKind::mirror);
    return mirror && mirror->counts() ? Value(mirror->mrays_per_second()) : std::nullopt;
}

Value build(const RayRow& row) {
    return row.build.runs ? Value(row.build.median) : std::nullopt;
}

/// A chart of the rows that `x` takes: a line for each name.
template <typename Name, typename X, typename Y>
void write_chart(const std::filesystem::path& path, const std::vector<RayRow>& rows, LineChart chart, Name name, X x,
                 Y y) {
    for (const RayRow& row : rows) {
        const Value at = x(row), value = y(row);
        if (!at || !value) continue;
        const std::string line = name(row);
        auto found = std::find_if(chart.series.begin(), chart.series.end(),
                                  [&](const ChartSeries& series) { return series.name == line; });
        if (found == chart.series.end()) found = chart.series.insert(chart.series.end(), {line, {}});
        found->points.emplace_back(*at, *value);
    }
    if (!chart.series.empty()) write_text(path, svg_of(chart));
}

}  // namespace

void write_plots(const std::filesystem::path& folder, const std::vector<RayRow>& rows) {
    const auto label = [](const RayRow& row) { return row.label(); };
    const auto blob_triangles = [](const RayRow& row) {
        return is_blob(row) && !row.series ? Value(double(row.triangles)) : std::nullopt;
    };
    const auto dynamic = [](const RayRow& row) { return row.dynamic_ms(); };
    write_chart(folder / "triangles_rate.svg", rows,
                {"Mirror rays over a blob", "triangles", "million rays per second", {}}, label, blob_triangles, rate);
    write_chart(folder / "triangles_dynamic.svg", rows,
                {"Build, mirror and shadow rays over a blob", "triangles", "milliseconds", {}}, label, blob_triangles,
                dynamic);
    write_chart(folder / "triangles_build.svg", rows, {"Building a blob anew", "triangles", "milliseconds", {}}, label,
                blob_triangles, build);
    write_chart(
        folder / "rays.svg", rows, {"Mirror rays over a blob", "rays", "milliseconds", {}}, label,
        [](const RayRow& row) {
            const TracedSet* mirror = row.set(RayKind::mirror);
            return row.series && mirror ? Value(double(mirror->rays)) : std::nullopt;
        },
        [](const RayRow& row) {
            const TracedSet* mirror = row.set(RayKind::mirror);
            return mirror && mirror->counts() ? Value(mirror->time.median) : std::nullopt;
        });
    const auto scene_and_hit = [](const RayRow& row) { return row.scene + ", " + row.contender; };
    const auto resolution = [](const RayRow& row) {
        return is_blob(row) && row.is_ours() && row.ldc && !row.series && row.traversal == Traversal::voxel
                   ? Value(double(*row.ldc))
                   : std::nullopt;
    };
    write_chart(folder / "ldc_rate.svg", rows,
                {"Mirror rays over blobs", "LDI resolution, pixels", "million rays per second", {}}, scene_and_hit,
                resolution, rate);
    write_chart(folder / "ldc_dynamic.svg", rows,
                {"Build, mirror and shadow rays over blobs", "LDI resolution, pixels", "milliseconds", {}},
                scene_and_hit, resolution, dynamic);
}

}  // namespace peelray
