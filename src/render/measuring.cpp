#include "render/measuring.h"

namespace peelray {
namespace {

bool is_build(const std::string& pass) {
    return pass.starts_with("build/");
}

bool is_of_maps(const std::string& pass) {
    return pass.starts_with("probe/") || pass.starts_with("shadow_map/");
}

}  // namespace

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::nth_element(values.begin(), values.begin() + ptrdiff_t(values.size() / 2), values.end());
    return values[values.size() / 2];
}

void TimeTable::add(const std::vector<PassTime>& times) {
    for (const PassTime& time : times) {
        auto found = std::find_if(rows_.begin(), rows_.end(), [&](const auto& row) { return row.name == time.name; });
        if (found == rows_.end()) found = rows_.insert(rows_.end(), {time.name, 0});
        found->ms += time.ms;
    }
}

void FrameMeter::add(const Commands& commands) {
    passes.add(commands.times());
    ms += commands.elapsed_ms();
}

void Measurement::add(const FrameMeter& frame) {
    redone_ += frame.redone;
    last_ = frame.passes;
    if (added_++ == 0 && repeat_ > 1) return;
    double build_ms = 0;
    for (const PassTime& row : frame.passes.rows()) {
        passes_[row.name].push_back(row.ms);
        if (is_build(row.name)) build_ms += row.ms;
    }
    frames_.push_back({frame.ms, build_ms});
}

void Measurement::describe(RenderStats& stats) const {
    stats.redone = redone_;
    stats.frames = frames_;
    std::vector<double> frame_ms;
    for (const RenderStats::FrameTime& frame : frames_) frame_ms.push_back(frame.frame_ms);
    stats.frame_ms = median(frame_ms);
    for (const PassTime& row : last_.rows()) {
        const auto found = passes_.find(row.name);
        const double ms = found == passes_.end() ? 0 : median(found->second);
        stats.passes.push_back({row.name, ms});
        if (is_build(row.name)) stats.build_ms += ms;
        if (is_of_maps(row.name)) stats.maps_ms += ms;
    }
}

}  // namespace peelray
