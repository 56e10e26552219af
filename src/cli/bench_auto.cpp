// `peelray bench --auto-check`: what `auto` chooses against the best fixed choice.
#include <algorithm>

#include "base/progress.h"
#include "bench/auto_check.h"
#include "cli/bench.h"
#include "cli/bench_output.h"
#include "cli/messages.h"
#include "cli/stats_json.h"
#include "cli/version.h"

namespace peelray {

using Json = nlohmann::ordered_json;

static std::string text_of(const AutoRow::Choice& choice) {
    return choice.ldc ? fmt::format("{} {}", name_of(choice.hit), *choice.ldc)
                      : fmt::format("auto ({})", name_of(choice.chosen));
}

static Json row_json(const AutoRow& row) {
    const bool measured = row.left_out.empty();
    Json fixed = Json::array();
    for (const AutoRow::Choice& choice : row.fixed)
        fixed.push_back({{"hit", name_of(choice.hit)}, {"n", *choice.ldc}, {"frame_ms", choice.ms}});
    return {{"scene", row.scene},
            {"shown", row.shown},
            {"stands_in", row.stands_in},
            {"triangles", row.triangles},
            {"cubes", row.rebuilt ? "rebuilt" : "kept"},
            {"left_out", measured ? Json(nullptr) : Json(reason_text(row.left_out))},
            {"auto_hit", measured ? name_of(row.automatic.chosen) : ""},
            {"auto_ms", row.automatic.ms},
            {"ratio_to_best", row.ratio()},
            {"ratio_to_best_of_its_hit_test", row.ratio_same()},
            {"fixed", fixed}};
}

static std::string table_row(const AutoRow& row) {
    if (!row.left_out.empty())
        return fmt::format("| {} | – | – | left out: {} | – | – | – | – | – | – |\n", row.scene,
                           one_line(reason_text(row.left_out)));
    return fmt::format("| {} | {} | {} | {} | {:.3f} | {} | {:.3f} | {:.2f} | {} | {:.2f} |\n", row.scene,
                       row.triangles, row.rebuilt ? "rebuilt" : "kept", text_of(row.automatic), row.automatic.ms,
                       text_of(row.best), row.best.ms, row.ratio(), text_of(row.best_same), row.ratio_same());
}

static std::string auto_table_head(const BenchArguments& a, const Machine& machine) {
    return fmt::format(
        "{}, driver {}, commit {}; {}x{} pixels, {} frames each; milliseconds of a frame, medians\n\n"
        "| scene | triangles | cubes | auto | frame | best of all | frame | auto by best | best of its hit "
        "test | auto by that |\n|---|---:|---|---|---:|---|---:|---:|---|---:|\n",
        machine.name, machine.driver, build_commit(), a.size.x, a.size.y, a.repeat);
}

void run_auto_check(const BenchArguments& a) {
    AutoCheck check(a, print_note);
    Json head = {{"benchmark", "auto"}};
    head.update(machine_json(check.machine()));
    head["image"] = {a.size.x, a.size.y};
    head["repeat"] = a.repeat;
    BenchOutput output(a, head);
    output.say(auto_table_head(a, check.machine()));
    Progress bar("measuring", double(check.rows()), "rows");
    double worst = 0, worst_same = 0;
    const auto add = [&](const AutoRow& row) {
        worst = std::max(worst, row.ratio());
        worst_same = std::max(worst_same, row.ratio_same());
        output.add(row_json(row), table_row(row), row.left_out);
    };
    const auto last = [&](bool complete) {
        if (complete && worst > 0)
            output.say(fmt::format(
                "\nAt worst auto takes {:.2f} times as long as the best fixed choice, {:.2f} times as long as "
                "the best of its own hit test.\n",
                worst, worst_same));
    };
    output.run(
        std::nullopt, [&] { check.run(add, [&](double rows) { bar.update(rows); }); }, last);
}

}  // namespace peelray
