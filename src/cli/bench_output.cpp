#include "cli/bench_output.h"

#include <fstream>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/text.h"
#include "cli/messages.h"
#include "cli/stats_json.h"
#include "image/image.h"

namespace peelray {

using Json = nlohmann::ordered_json;

BenchOutput::BenchOutput(const BenchArguments& arguments, Json head, std::string foot)
    : arguments_(arguments), head_(std::move(head)), foot_(std::move(foot)) {}

void BenchOutput::say(const std::string& text) {
    text_ += text;
    fmt::print("{}", text);
    std::fflush(stdout);
}

void BenchOutput::add(Json row, const std::string& line, const std::string& left_out) {
    rows_.push_back(std::move(row));
    if (left_out.empty())
        measured_++;
    else if (reason_.empty())
        reason_ = left_out;
    say(line);
    write(false);
}

void BenchOutput::write(bool complete) const {
    if (!arguments_.output.empty()) {
        Json json = head_;
        json["complete"] = complete;
        json["rows"] = rows_;
        write_json(arguments_.output, json);
    }
    if (!arguments_.markdown.empty()) write_text(arguments_.markdown, text_ + foot_);
}

void BenchOutput::run(std::optional<size_t> in_all, const std::function<void()>& measure,
                      const std::function<void(bool complete)>& last) {
    bool complete = false;
    try {
        measure();
        complete = true;
    } catch (const Interrupted&) {
    }
    foot_.clear();
    last(complete);
    write(complete);
    if (!complete)
        fail("interrupted after {}{}",
             in_all ? fmt::format("{} of {}", rows_.size(), counted("{} row{|s}", *in_all))
                    : counted("{} row{|s}", rows_.size()),
             arguments_.output.empty() ? "" : fmt::format(", which {} holds", arguments_.output.string()));
    if (measured_ == 0) fail("none of {} could be measured: {}", counted("{} row{|s}", rows_.size()), reason_);
}

Json timing_json(const Timing& timing) {
    if (timing.runs == 0) return nullptr;
    return {{"median", timing.median}, {"least", timing.least}, {"most", timing.most},
            {"drift", timing.drift},   {"clock", timing.clock}, {"runs", timing.runs}};
}

std::string reason_text(const std::string& left_out) {
    return message_of(Error(left_out));
}

std::string table_cell(const std::string& text) {
    std::string out;
    for (const char c : one_line(text)) out += c == '|' ? std::string("\\|") : std::string(1, c);
    return out;
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    write_atomically(path, [&](const std::filesystem::path& temporary) {
        std::ofstream stream(temporary);
        stream << text;
        stream.close();
        if (!stream) fail("cannot write '{}': is the disk full?", path.string());
    });
}

}  // namespace peelray
