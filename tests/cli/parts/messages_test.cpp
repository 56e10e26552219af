// Texts on the terminal and in tables.
#include "cli/messages.h"

#include "cli/bench_output.h"
#include "image/temp_folder.h"

namespace peelray {
namespace {

TEST(Messages, AreOneLineWithoutTerminalCodes) {
    EXPECT_EQ(one_line("a\nb\r\tc"), "a b  c");
    EXPECT_EQ(one_line("\x1b[31mred\x7f"), " [31mred ");
    EXPECT_EQ(one_line("gr\xc3\xbc\xc3\x9f"
                       "e, 5 \xc2\xb5s"),
              "gr\xc3\xbc\xc3\x9f"
              "e, 5 \xc2\xb5s");
    EXPECT_EQ(one_line(""), "");
}

TEST(Messages, NameSettingsAsFlags) {
    try {
        fail("{} of 5 (see {})", setting::ldc, setting::hit);
    } catch (const Error& error) {
        EXPECT_EQ(message_of(error), "--ldc of 5 (see --hit)");
        EXPECT_EQ(reason_text(error.text()), "--ldc of 5 (see --hit)");
    }
}

TEST(Messages, NotesAreMarkedAsNotes) {
    testing::internal::CaptureStderr();
    print_note(fmt::format("{} is\nlarge", setting::spp));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "peelray: note: --spp is large\n");
}

TEST(Messages, CellsOfATableKeepTheirColumns) {
    EXPECT_EQ(table_cell("a|b\n|c"), "a\\|b \\|c");
}

}  // namespace
}  // namespace peelray
