// Files told from each other by their content.
#include "cli/content_hash.h"

#include <set>

#include "image/temp_folder.h"

namespace peelray {
namespace {

class ContentHash : public TempFolder {};

TEST_F(ContentHash, IsWhatXxh128sumPrints) {
    EXPECT_EQ(content_hash(put("empty", "")), "xxh128:99aa06d3014798d86001c324468d497f");
}

TEST_F(ContentHash, FollowsFromEveryByteAndNothingElse) {
    // Longer than what is read at once.
    const std::string text((1 << 20) + 17, 'x');
    const std::string before = content_hash(put("a", text));
    EXPECT_EQ(before.size(), 7u + 32u);
    EXPECT_EQ(content_hash(put("b", text)), before);
    std::set<std::string> hashes = {before};
    for (const size_t place : {size_t(0), size_t(1 << 20) - 1, size_t(1 << 20), text.size() - 1}) {
        std::string changed = text;
        changed[place] = 'y';
        hashes.insert(content_hash(put("c", changed)));
    }
    hashes.insert(content_hash(put("d", text + 'x')));
    hashes.insert(content_hash(put("e", text + '\0')));
    EXPECT_EQ(hashes.size(), 7u);
}

TEST_F(ContentHash, OfWhatCannotBeReadIsAnError) {
    expect_error([&] { content_hash(folder / "nothing"); }, "cannot read");
    expect_error([&] { content_hash(folder); }, "cannot read");
}

}  // namespace
}  // namespace peelray
