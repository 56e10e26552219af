// How every benchmark ends: whole, interrupted, or with nothing measured. Finished rows are never lost.
#include "cli/bench_output.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/interrupt.h"

namespace peelray {
namespace {

using Json = nlohmann::ordered_json;

class BenchOutputTest : public testing::Test {
  protected:
    BenchOutputTest() {
        std::filesystem::create_directories(folder_);
        arguments_.output = folder_ / "rows.json";
        arguments_.markdown = folder_ / "table.md";
        testing::internal::CaptureStdout();
    }
    ~BenchOutputTest() override {
        testing::internal::GetCapturedStdout();
        std::filesystem::remove_all(folder_);
    }

    Json json() const {
        std::ifstream stream(arguments_.output);
        return Json::parse(stream);
    }
    std::string markdown() const {
        std::ifstream stream(arguments_.markdown);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    /// The line of the Error that a run ends with; empty: none.
    std::string line_of(BenchOutput& output, const std::function<void()>& measure,
                        std::optional<size_t> in_all = std::nullopt) {
        try {
            output.run(in_all, measure, [&](bool complete) { output.say(complete ? "end\n" : "so far\n"); });
        } catch (const Error& error) {
            return error.line("--");
        }
        return "";
    }

    const std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / fmt::format("peelray-bench-output-{}", ::getpid());
    BenchArguments arguments_;
};

TEST_F(BenchOutputTest, ARowIsInTheFilesAtOnce) {
    BenchOutput output(arguments_, {{"benchmark", "rays"}}, "foot\n");
    output.say("head\n");
    output.add({{"scene", "a"}}, "row a\n", "");
    EXPECT_EQ(markdown(), "head\nrow a\nfoot\n");
    EXPECT_EQ(json(), (Json{{"benchmark", "rays"}, {"complete", false}, {"rows", {{{"scene", "a"}}}}}));
}

TEST_F(BenchOutputTest, AWholeRunSaysSo) {
    BenchOutput output(arguments_, {{"benchmark", "rays"}}, "foot\n");
    EXPECT_EQ(line_of(output, [&] { output.add({{"scene", "a"}}, "row a\n", ""); }), "");
    EXPECT_EQ(markdown(), "row a\nend\n");
    EXPECT_EQ(json()["complete"], true);
}

TEST_F(BenchOutputTest, AnInterruptKeepsWhatWasMeasured) {
    const auto measure = [](BenchOutput& output) {
        output.add({{"scene", "a"}}, "row a\n", "");
        throw Interrupted("stopped");
    };
    BenchOutput output(arguments_, {{"benchmark", "rays"}}, "foot\n");
    EXPECT_EQ(line_of(
                  output, [&] { measure(output); }, 3),
              "interrupted after 1 of 3 rows, which " + arguments_.output.string() + " holds");
    EXPECT_EQ(markdown(), "row a\nso far\n") << "one foot, not two";
    EXPECT_EQ(json()["complete"], false);
    EXPECT_EQ(json()["rows"].size(), 1u);
    arguments_.output.clear();
    BenchOutput without(arguments_, {});
    EXPECT_EQ(line_of(without, [&] { measure(without); }), "interrupted after 1 row");
}

TEST_F(BenchOutputTest, WhereNothingWasMeasuredTheFirstReasonIsSaid) {
    BenchOutput output(arguments_, {});
    const std::string reason = fmt::format("too fine: choose less ({})", setting::ldc);
    EXPECT_EQ(line_of(output,
                      [&] {
                          output.add({}, "row\n", reason);
                          output.add({}, "row\n", "another");
                      }),
              "none of 2 rows could be measured: too fine: choose less (--ldc)");
    EXPECT_EQ(reason_text(reason), "too fine: choose less (--ldc)");
    EXPECT_EQ(json()["complete"], true);
}

}  // namespace
}  // namespace peelray
