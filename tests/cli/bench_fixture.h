// Small runs of `peelray bench`.
#pragma once

#include "cli/sequence_fixture.h"

namespace peelray {

/// Runs without the models, so that built-in scenes stand in.
class BenchFixture : public SequenceTest {
  protected:
    /// `options`: of every run, beside an empty folder as --models.
    explicit BenchFixture(Words options) : options_(std::move(options)) {}

    void SetUp() override {
        SequenceTest::SetUp();
        std::filesystem::create_directory(folder / "models");
    }

    /// A small run; options of `more` take the place of the fixture's.
    Words small(const Words& more = {}) const {
        Words all = {"bench", "--models", in("models")};
        all.insert(all.end(), options_.begin(), options_.end());
        for (const std::string& word : more) {
            const auto found = std::find(all.begin(), all.end(), word);
            if (word.starts_with("--") && found != all.end()) all.erase(found, found + 2);
        }
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    nlohmann::json json(const std::string& name = "b.json") const { return nlohmann::json::parse(get(out(name))); }

  private:
    Words options_;
};

}  // namespace peelray
