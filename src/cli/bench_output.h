// What a run of `peelray bench` leaves behind, the same for every benchmark.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "bench/timing.h"
#include "cli/arguments.h"

namespace peelray {

/// Text on the terminal and in --markdown, rows in --out. What there is goes to the files at once, so that nothing that
/// ends the run takes it away.
class BenchOutput {
  public:
    /// `head`: what the JSON says before its rows. `foot`: what stands below a table that is not finished.
    BenchOutput(const BenchArguments& arguments, nlohmann::ordered_json head, std::string foot = "");

    void say(const std::string& text);
    /// `left_out`: why the row was not measured, as Error::text(); empty: it was.
    void add(nlohmann::ordered_json row, const std::string& line, const std::string& left_out);

    /// The whole run: `measure` adds the rows, `last` says what stands below them. Throws Error where it was
    /// interrupted or no row could be measured. `in_all`: rows there would be, if that is known.
    void run(std::optional<size_t> in_all, const std::function<void()>& measure,
             const std::function<void(bool complete)>& last);

  private:
    void write(bool complete) const;

    const BenchArguments& arguments_;
    nlohmann::ordered_json head_, rows_ = nlohmann::ordered_json::array();
    std::string text_, foot_, reason_;
    size_t measured_ = 0;
};

/// The times as JSON; null without runs.
nlohmann::ordered_json timing_json(const Timing& timing);
/// Why something was left out, with settings as their flags.
std::string reason_text(const std::string& left_out);
/// Fit for a cell of a Markdown table.
std::string table_cell(const std::string& text);
/// Writes a text to a file, whole or not at all.
void write_text(const std::filesystem::path& path, const std::string& text);

}  // namespace peelray
