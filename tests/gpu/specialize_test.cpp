// Specialisation constants put into the code of shaders.
#include "gpu/specialize.h"

#include <gtest/gtest.h>

#include <set>
#include <spirv_cross/spirv_cross.hpp>

#include "gpu/shader_table.h"

namespace peelray {
namespace {

/// How often each instruction is there.
std::map<uint32_t, uint32_t> instructions_of(std::span<const uint32_t> code) {
    std::map<uint32_t, uint32_t> found;
    for (size_t at = 5; at < code.size(); at += code[at] >> spv::WordCountShift) found[code[at] & spv::OpCodeMask]++;
    return found;
}

/// By constant_id: is it a bool?
std::map<uint32_t, bool> constants_of(std::span<const uint32_t> code) {
    const spirv_cross::Compiler compiler(std::vector<uint32_t>(code.begin(), code.end()));
    std::map<uint32_t, bool> found;
    for (const auto& constant : compiler.get_specialization_constants()) {
        const auto& type = compiler.get_type(compiler.get_constant(constant.id).constant_type);
        found[constant.constant_id] = type.basetype == spirv_cross::SPIRType::Boolean;
    }
    return found;
}

// A shader that keeps one is looked through again for each of its pipelines: tests of pictures would take twice as
// long.
TEST(Specialize, NoShaderKeepsAnyAndNothingElseChanges) {
    size_t with = 0;
    for (const EmbeddedShader& shader : peelray_shaders()) {
        SCOPED_TRACE(shader.name);
        const auto constants = constants_of(shader.code);
        for (const uint32_t value : {0u, 1u, 7u}) {
            std::map<uint32_t, uint32_t> values;
            for (const auto& [number, is_bool] : constants) values[number] = is_bool ? value & 1 : value;
            const auto code = specialize(shader.code, values);
            auto before = instructions_of(shader.code), after = instructions_of(code);
            if (values.empty()) {
                EXPECT_TRUE(std::ranges::equal(code, shader.code));
                continue;
            }
            with++;
            uint32_t constants_before = 0, constants_after = 0;
            for (const spv::Op op : {spv::OpSpecConstantTrue, spv::OpSpecConstantFalse, spv::OpSpecConstant,
                                     spv::OpSpecConstantComposite, spv::OpSpecConstantOp}) {
                EXPECT_EQ(after[op], 0u) << "instruction " << op << ": specialize() does not know it";
                constants_before += before[op];
                before.erase(op), after.erase(op);
            }
            for (const spv::Op op : {spv::OpConstantTrue, spv::OpConstantFalse, spv::OpConstant}) {
                constants_before += before[op];
                constants_after += after[op];
                before.erase(op), after.erase(op);
            }
            EXPECT_EQ(constants_after, constants_before);
            before[spv::OpDecorate] -= uint32_t(values.size());
            EXPECT_EQ(after, before);
        }
    }
    EXPECT_GT(with, 60u);
}

/// `uint a = 5, bool b = true` by numbers 3 and 1, an OpConstant of 6, and `op` of the type `bool` or `uint` on them.
std::vector<uint32_t> code_with(spv::Op op, bool of_bools, std::initializer_list<uint32_t> operands) {
    enum : uint32_t { word = 1, boolean, a, b, six, result };
    std::vector<uint32_t> code = {spv::MagicNumber, 0x10000, 0, result + 1, 0};
    const auto add = [&](spv::Op what, std::vector<uint32_t> rest) {
        code.push_back(uint32_t(rest.size() + 1) << spv::WordCountShift | what);
        code.insert(code.end(), rest.begin(), rest.end());
    };
    add(spv::OpDecorate, {a, spv::DecorationSpecId, 3});
    add(spv::OpDecorate, {b, spv::DecorationSpecId, 1});
    add(spv::OpTypeInt, {word, 32, 0});
    add(spv::OpTypeBool, {boolean});
    add(spv::OpSpecConstant, {word, a, 5});
    add(spv::OpSpecConstantTrue, {boolean, b});
    add(spv::OpConstant, {word, six, 6});
    std::vector<uint32_t> last = {of_bools ? boolean : word, result, uint32_t(op)};
    last.insert(last.end(), operands);
    add(spv::OpSpecConstantOp, last);
    return code;
}

TEST(Specialize, WhatFollowsFromConstantsIsFolded) {
    constexpr uint32_t a = 3, b = 4, six = 5;
    struct Case {
        spv::Op op;
        bool of_bools;
        std::initializer_list<uint32_t> operands;
        uint32_t by_default, with_values;  // a = 5, b = true; a = 7, b = false
    };
    for (const Case& c :
         {Case{spv::OpLogicalNot, true, {b}, 0, 1}, Case{spv::OpLogicalAnd, true, {b, b}, 1, 0},
          Case{spv::OpLogicalOr, true, {b, b}, 1, 0}, Case{spv::OpIEqual, true, {a, six}, 0, 0},
          Case{spv::OpIEqual, true, {a, a}, 1, 1}, Case{spv::OpINotEqual, true, {a, six}, 1, 1},
          Case{spv::OpINotEqual, true, {a, a}, 0, 0}, Case{spv::OpULessThan, true, {a, six}, 1, 0},
          Case{spv::OpULessThan, true, {six, a}, 0, 1}, Case{spv::OpBitwiseAnd, false, {a, six}, 4, 6},
          Case{spv::OpSelect, false, {b, a, six}, 5, 6}, Case{spv::OpSelect, false, {b, six, a}, 6, 7}}) {
        const auto code = code_with(c.op, c.of_bools, c.operands);
        for (const bool given : {false, true}) {
            SCOPED_TRACE(testing::Message() << "instruction " << c.op << (given ? ", values" : ", defaults"));
            const auto plain = given ? specialize(code, {{3, 7}, {1, 0}, {20, 1}}) : specialize(code, {});
            const uint32_t wanted = given ? c.with_values : c.by_default;
            if (c.of_bools) {
                ASSERT_EQ(plain[plain.size() - 3],
                          3u << spv::WordCountShift | (wanted ? spv::OpConstantTrue : spv::OpConstantFalse));
                EXPECT_EQ(plain.back(), 6u);
            } else {
                ASSERT_EQ(plain[plain.size() - 4], 4u << spv::WordCountShift | spv::OpConstant);
                EXPECT_EQ(plain.back(), wanted);
            }
        }
    }
}

TEST(Specialize, WhatItDoesNotKnowIsLeft) {
    const auto code = code_with(spv::OpIAdd, false, {3, 5});
    const auto plain = specialize(code, {});
    EXPECT_EQ(instructions_of(plain)[spv::OpSpecConstantOp], 1u);
    EXPECT_TRUE(std::equal(code.end() - 6, code.end(), plain.end() - 6));
}

}  // namespace
}  // namespace peelray
