#include "gpu/specialize.h"

#include <optional>
#include <set>
#include <spirv_cross/spirv.hpp>

namespace peelray {
namespace {

/// Writes the code again, instruction by instruction.
class Writer {
  public:
    explicit Writer(const std::map<uint32_t, uint32_t>& values) : values_(values) {}

    void add(std::span<const uint32_t> instruction) {
        switch (spv::Op(instruction[0] & spv::OpCodeMask)) {
            case spv::OpDecorate:
                if (instruction[2] != spv::DecorationSpecId) break;
                numbers_[instruction[1]] = instruction[3];
                return;
            case spv::OpTypeBool:
                bools_ = instruction[1];
                break;
            case spv::OpTypeInt:
                if (instruction[2] == 32) words_.insert(instruction[1]);
                break;
            case spv::OpConstantTrue:
            case spv::OpConstantFalse:
                return constant(instruction, (instruction[0] & spv::OpCodeMask) == spv::OpConstantTrue);
            case spv::OpConstant:
                if (!words_.contains(instruction[1])) break;
                return constant(instruction, instruction[3]);
            case spv::OpSpecConstantTrue:
            case spv::OpSpecConstantFalse:
                return constant(instruction,
                                given(instruction[2], (instruction[0] & spv::OpCodeMask) == spv::OpSpecConstantTrue));
            case spv::OpSpecConstant: {
                const uint32_t value = given(instruction[2], instruction[3]);
                if (words_.contains(instruction[1])) return constant(instruction, value);
                return write(spv::OpConstant, {instruction[1], instruction[2], value});
            }
            case spv::OpSpecConstantOp:
                if (const auto value = folded(instruction)) return constant(instruction, *value);
                break;  // by the driver
            default:
                break;
        }
        code.insert(code.end(), instruction.begin(), instruction.end());
    }

    std::vector<uint32_t> code;

  private:
    void write(spv::Op op, std::initializer_list<uint32_t> operands) {
        code.push_back(uint32_t(operands.size() + 1) << spv::WordCountShift | op);
        code.insert(code.end(), operands);
    }

    /// A bool or 32 bits, of the type and with the name of `instruction`.
    void constant(std::span<const uint32_t> instruction, uint32_t value) {
        known_[instruction[2]] = value;
        if (instruction[1] == bools_)
            write(value ? spv::OpConstantTrue : spv::OpConstantFalse, {instruction[1], instruction[2]});
        else
            write(spv::OpConstant, {instruction[1], instruction[2], value});
    }

    uint32_t given(uint32_t name, uint32_t otherwise) const {
        const auto number = numbers_.find(name);
        const auto value = number == numbers_.end() ? values_.end() : values_.find(number->second);
        return value == values_.end() ? otherwise : value->second;
    }

    /// What an OpSpecConstantOp comes to, if it is one of those that the shaders have.
    std::optional<uint32_t> folded(std::span<const uint32_t> instruction) const {
        if (instruction[1] != bools_ && !words_.contains(instruction[1])) return {};
        std::vector<uint32_t> v;
        for (const uint32_t operand : instruction.subspan(4)) {
            const auto known = known_.find(operand);
            if (known == known_.end()) return {};
            v.push_back(known->second);
        }
        switch (spv::Op(instruction[3])) {
            case spv::OpLogicalNot:
                return !v[0];
            case spv::OpLogicalAnd:
                return v[0] && v[1];
            case spv::OpLogicalOr:
                return v[0] || v[1];
            case spv::OpIEqual:
                return v[0] == v[1];
            case spv::OpINotEqual:
                return v[0] != v[1];
            case spv::OpULessThan:
                return v[0] < v[1];
            case spv::OpBitwiseAnd:
                return v[0] & v[1];
            case spv::OpSelect:
                return v[0] ? v[1] : v[2];
            default:
                return {};
        }
    }

    const std::map<uint32_t, uint32_t>& values_;
    std::map<uint32_t, uint32_t> numbers_;  ///< constant_id by name
    std::map<uint32_t, uint32_t> known_;    ///< values by name
    std::set<uint32_t> words_;              ///< types of 32 bits
    uint32_t bools_ = 0;                    ///< their type
};

}  // namespace

std::vector<uint32_t> specialize(std::span<const uint32_t> code, const std::map<uint32_t, uint32_t>& values) {
    constexpr size_t kHeader = 5;
    Writer writer(values);
    writer.code.reserve(code.size());
    writer.code.assign(code.begin(), code.begin() + kHeader);
    for (size_t at = kHeader; at < code.size();) {
        const size_t words = code[at] >> spv::WordCountShift;
        writer.add(code.subspan(at, words));
        at += words;
    }
    return std::move(writer.code);
}

}  // namespace peelray
