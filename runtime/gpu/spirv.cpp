// SPIR-V words in, what a pipeline layout needs out; the decoration that keeps float arithmetic as written, and the
// mode that brings lanes together again.
#include "runtime/gpu/spirv.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <set>
#include <spirv/unified1/spirv.hpp11>
#include <unordered_map>

namespace espalier {
namespace {

constexpr size_t kHeaderWords = 5;
constexpr uint32_t kMaxIds = 1u << 22;  // a hostile bound must not make us allocate

struct Instruction {
    spv::Op op;
    std::span<const uint32_t> words;  // with the first, which holds opcode and length
    uint32_t operator[](size_t i) const { return words[i]; }
    size_t size() const { return words.size(); }
};

// Calls visit for each instruction; false if the lengths don't add up.
template <class Visit>
bool forEachInstruction(std::span<const uint32_t> code, Visit visit) {
    for (size_t at = kHeaderWords; at < code.size();) {
        const uint32_t length = code[at] >> 16;
        if (length == 0 || length > code.size() - at) return false;
        visit(Instruction{spv::Op(code[at] & 0xFFFFu), code.subspan(at, length)}, at);
        at += length;
    }
    return true;
}

// Operands that the reader relies on, as a minimum length of the instruction.
size_t minimumWords(spv::Op op) {
    switch (op) {
        case spv::Op::OpName:
            return 3;
        case spv::Op::OpMemberName:
            return 4;
        case spv::Op::OpEntryPoint:
            return 4;
        case spv::Op::OpExecutionMode:
        case spv::Op::OpExecutionModeId:
            return 3;
        case spv::Op::OpDecorate:
            return 3;
        case spv::Op::OpMemberDecorate:
            return 4;
        case spv::Op::OpTypeInt:
            return 4;
        case spv::Op::OpTypeFloat:
            return 3;
        case spv::Op::OpTypeVector:
        case spv::Op::OpTypeMatrix:
        case spv::Op::OpTypeArray:
            return 4;
        case spv::Op::OpTypeImage:
            return 9;
        case spv::Op::OpTypePointer:
            return 4;
        case spv::Op::OpTypeStruct:
            return 2;
        case spv::Op::OpConstant:
        case spv::Op::OpSpecConstant:
            return 4;
        case spv::Op::OpConstantComposite:
        case spv::Op::OpSpecConstantComposite:
            return 3;
        case spv::Op::OpVariable:
            return 4;
        default:
            return 1;
    }
}

std::string textAt(const Instruction& in, size_t word) {
    std::string text;
    for (size_t i = word; i < in.size(); ++i)
        for (int byte = 0; byte < 4; ++byte) {
            const char c = char(in[i] >> (8 * byte));
            if (!c) return text;
            text += c;
        }
    return text;
}

using Key = uint64_t;  // id, member + 1, decoration
Key key(uint32_t id, uint32_t member, spv::Decoration d) {
    return (uint64_t(id) << 40) ^ (uint64_t(member & 0xFFFFFu) << 20) ^ uint64_t(d);
}

// An index over a module's declarations.
struct Module {
    std::unordered_map<uint32_t, Instruction> definitions;  // types, constants, variables by result id
    std::vector<Instruction> variables, entryPoints, modes;
    std::vector<uint32_t> structs;
    std::unordered_map<Key, uint32_t> decorations;  // the first operand, or 0
    std::unordered_map<uint32_t, std::string> names;
    std::map<std::pair<uint32_t, uint32_t>, std::string> memberNames;
    std::unordered_map<uint32_t, uint32_t> specialized;  // SpecId -> value

    const Instruction* find(uint32_t id) const {
        auto it = definitions.find(id);
        return it == definitions.end() ? nullptr : &it->second;
    }
    std::optional<uint32_t> decoration(uint32_t id, spv::Decoration d) const { return lookUp(key(id, 0, d)); }
    std::optional<uint32_t> decoration(uint32_t id, uint32_t member, spv::Decoration d) const {
        return lookUp(key(id, member + 1, d));
    }
    std::optional<uint32_t> lookUp(Key k) const {
        auto it = decorations.find(k);
        return it == decorations.end() ? std::nullopt : std::optional(it->second);
    }
    uint32_t constant(uint32_t id) const {
        const Instruction* in = find(id);
        if (!in || (in->op != spv::Op::OpConstant && in->op != spv::Op::OpSpecConstant)) return 0;
        if (auto specId = decoration(id, spv::Decoration::SpecId))
            if (auto it = specialized.find(*specId); it != specialized.end()) return it->second;
        return (*in)[3];
    }
    uint32_t sizeBytes(uint32_t type, uint32_t matrixStride, int depth = 0) const;
};

void index(Module& m, const Instruction& in) {
    switch (in.op) {
        case spv::Op::OpName:
            m.names[in[1]] = textAt(in, 2);
            break;
        case spv::Op::OpMemberName:
            m.memberNames[{in[1], in[2]}] = textAt(in, 3);
            break;
        case spv::Op::OpEntryPoint:
            m.entryPoints.push_back(in);
            break;
        case spv::Op::OpExecutionMode:
        case spv::Op::OpExecutionModeId:
            m.modes.push_back(in);
            break;
        case spv::Op::OpDecorate:
            m.decorations[key(in[1], 0, spv::Decoration(in[2]))] = in.size() > 3 ? in[3] : 0;
            break;
        case spv::Op::OpMemberDecorate:
            m.decorations[key(in[1], in[2] + 1, spv::Decoration(in[3]))] = in.size() > 4 ? in[4] : 0;
            break;
        case spv::Op::OpVariable:
            m.variables.push_back(in);
            break;
        case spv::Op::OpConstant:
        case spv::Op::OpSpecConstant:
        case spv::Op::OpConstantComposite:
        case spv::Op::OpSpecConstantComposite:
            m.definitions.insert_or_assign(in[2], in);
            break;
        case spv::Op::OpTypeStruct:
            m.structs.push_back(in[1]);
            [[fallthrough]];
        default:
            if (in.op >= spv::Op::OpTypeVoid && in.op <= spv::Op::OpTypePipe && in.size() > 1)
                m.definitions.insert_or_assign(in[1], in);
    }
}

// Bytes of a value with an explicit layout. depth: hostile types may nest without end.
uint32_t Module::sizeBytes(uint32_t type, uint32_t matrixStride, int depth) const {
    const Instruction* in = find(type);
    if (!in || depth > 32) return 0;
    switch (in->op) {
        case spv::Op::OpTypeInt:
        case spv::Op::OpTypeFloat:
            return (*in)[2] / 8;
        case spv::Op::OpTypePointer:
            return 8;
        case spv::Op::OpTypeVector:
            return sizeBytes((*in)[2], 0, depth + 1) * (*in)[3];
        case spv::Op::OpTypeMatrix:
            return matrixStride * (*in)[3];
        case spv::Op::OpTypeArray:
            return decoration(type, spv::Decoration::ArrayStride).value_or(0) * constant((*in)[3]);
        case spv::Op::OpTypeStruct: {
            uint32_t end = 0;
            for (uint32_t i = 0; i + 2 < in->size(); ++i) {
                const uint32_t stride = decoration(type, i, spv::Decoration::MatrixStride).value_or(0);
                end = std::max(end, decoration(type, i, spv::Decoration::Offset).value_or(0) +
                                        sizeBytes((*in)[i + 2], stride, depth + 1));
            }
            return end;
        }
        default:
            return 0;
    }
}

std::optional<VkShaderStageFlagBits> stageOf(uint32_t model) {
    switch (spv::ExecutionModel(model)) {
        case spv::ExecutionModel::Vertex:
            return VK_SHADER_STAGE_VERTEX_BIT;
        case spv::ExecutionModel::Fragment:
            return VK_SHADER_STAGE_FRAGMENT_BIT;
        case spv::ExecutionModel::GLCompute:
            return VK_SHADER_STAGE_COMPUTE_BIT;
        default:
            return std::nullopt;
    }
}

void readLocalSize(const Module& m, ShaderInterface& out) {
    for (const Instruction& mode : m.modes) {
        const bool byId = mode.op == spv::Op::OpExecutionModeId;
        const auto kind = spv::ExecutionMode(mode[2]);
        if (mode.size() < 6 || kind != (byId ? spv::ExecutionMode::LocalSizeId : spv::ExecutionMode::LocalSize))
            continue;
        for (size_t i = 0; i < 3; ++i) out.localSize[i] = byId ? m.constant(mode[3 + i]) : mode[3 + i];
    }
    // local_size_x_id makes a composite constant that overrides the mode.
    for (const auto& [id, in] : m.definitions) {
        const bool composite = in.op == spv::Op::OpSpecConstantComposite || in.op == spv::Op::OpConstantComposite;
        if (composite && in.size() == 6 &&
            m.decoration(id, spv::Decoration::BuiltIn) == uint32_t(spv::BuiltIn::WorkgroupSize))
            for (size_t i = 0; i < 3; ++i) out.localSize[i] = m.constant(in[3 + i]);
    }
}

std::optional<VkDescriptorType> descriptorType(const Module& m, spv::StorageClass storage, uint32_t type) {
    const Instruction* in = m.find(type);
    if (!in) return std::nullopt;
    if (storage == spv::StorageClass::StorageBuffer) return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    if (storage == spv::StorageClass::Uniform)
        return m.decoration(type, spv::Decoration::BufferBlock) ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                                                : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    switch (in->op) {
        case spv::Op::OpTypeSampledImage:
            return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        case spv::Op::OpTypeSampler:
            return VK_DESCRIPTOR_TYPE_SAMPLER;
        case spv::Op::OpTypeImage:
            // "samplerBuffer" is a texel buffer and no sampled image.
            if ((*in)[7] == 1 && (*in)[3] == uint32_t(spv::Dim::Buffer)) return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
            return (*in)[7] == 2 ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
        default:
            return std::nullopt;  // an array of descriptors among them
    }
}

Status readVariables(std::string_view name, const Module& m, ShaderInterface& out) {
    for (const Instruction& variable : m.variables) {
        const auto storage = spv::StorageClass(variable[3]);
        const Instruction* pointer = m.find(variable[1]);
        if (!pointer || pointer->op != spv::Op::OpTypePointer) return Failure(name, "SPIR-V: a variable has no type");
        const uint32_t type = (*pointer)[3];
        if (storage == spv::StorageClass::PushConstant) out.pushBytes = std::max(out.pushBytes, m.sizeBytes(type, 0));
        const bool bound = storage == spv::StorageClass::UniformConstant || storage == spv::StorageClass::Uniform ||
                           storage == spv::StorageClass::StorageBuffer;
        if (!bound) continue;
        const auto binding = m.decoration(variable[2], spv::Decoration::Binding);
        const auto kind = descriptorType(m, storage, type);
        if (m.decoration(variable[2], spv::Decoration::DescriptorSet).value_or(0) != 0 || !binding || !kind)
            return Failure(name, "SPIR-V: a resource is not a single descriptor with a binding in set 0");
        out.slots.push_back({*binding, *kind});
    }
    std::ranges::sort(out.slots);
    out.slots.erase(std::unique(out.slots.begin(), out.slots.end()), out.slots.end());
    return Done{};
}

void readLayouts(const Module& m, ShaderInterface& out) {
    for (const auto& [id, in] : m.definitions) {
        if (in.op != spv::Op::OpTypeArray && in.op != spv::Op::OpTypeRuntimeArray) continue;
        const auto name = m.names.find(in[2]);
        const auto stride = m.decoration(id, spv::Decoration::ArrayStride);
        if (name != m.names.end() && stride) out.strides[name->second] = *stride;
    }
    for (uint32_t id : m.structs) {
        const Instruction& in = *m.find(id);
        auto name = m.names.find(id);
        if (name == m.names.end() || !m.decoration(id, 0u, spv::Decoration::Offset)) continue;
        auto& members = out.layouts[name->second];
        members.clear();
        for (uint32_t i = 0; i + 2 < in.size(); ++i) {
            auto member = m.memberNames.find({id, i});
            members.emplace_back(member == m.memberNames.end() ? "" : member->second,
                                 m.decoration(id, i, spv::Decoration::Offset).value_or(0));
        }
    }
}

// What a compiler may fuse or regroup. OpExtInst isn't here: built-in functions have no exact result anyway.
bool isFloatArithmetic(spv::Op op) {
    switch (op) {
        case spv::Op::OpFNegate:
        case spv::Op::OpFAdd:
        case spv::Op::OpFSub:
        case spv::Op::OpFMul:
        case spv::Op::OpFDiv:
        case spv::Op::OpFRem:
        case spv::Op::OpFMod:
        case spv::Op::OpVectorTimesScalar:
        case spv::Op::OpMatrixTimesScalar:
        case spv::Op::OpVectorTimesMatrix:
        case spv::Op::OpMatrixTimesVector:
        case spv::Op::OpMatrixTimesMatrix:
        case spv::Op::OpOuterProduct:
        case spv::Op::OpDot:
            return true;
        default:
            return false;
    }
}

bool isDeclaration(spv::Op op) {
    return (op >= spv::Op::OpTypeVoid && op <= spv::Op::OpTypeForwardPointer) ||
           (op >= spv::Op::OpConstantTrue && op <= spv::Op::OpSpecConstantOp) || op == spv::Op::OpVariable ||
           op == spv::Op::OpUndef || op == spv::Op::OpFunction;
}

}  // namespace

Result<ShaderInterface> reflect(std::string_view name, std::span<const uint32_t> code,
                                std::span<const SpecConstant> constants) {
    if (code.size() < kHeaderWords || code[0] != spv::MagicNumber || code[3] > kMaxIds)
        return Failure(name, "not a SPIR-V module");
    Module m;
    for (const SpecConstant& c : constants) m.specialized[c.id] = c.value;
    bool wholeInstructions = true;
    const bool wholeModule = forEachInstruction(code, [&](const Instruction& in, size_t) {
        if (in.size() < minimumWords(in.op))
            wholeInstructions = false;
        else
            index(m, in);
    });
    if (!wholeModule || !wholeInstructions) return Failure(name, "SPIR-V: truncated or malformed");
    if (m.entryPoints.size() != 1) return Failure(name, "SPIR-V: there must be one entry point");
    const auto stage = stageOf(m.entryPoints[0][1]);
    if (!stage) return Failure(name, "SPIR-V: neither a compute, vertex nor fragment shader");
    ShaderInterface out;
    out.stage = *stage;
    out.entryPoint = textAt(m.entryPoints[0], 3);
    readLocalSize(m, out);
    if (Status status = readVariables(name, m, out); !status) return status.failure();
    readLayouts(m, out);
    return out;
}

std::vector<uint32_t> withoutContraction(std::span<const uint32_t> code) {
    std::set<uint32_t> done;
    std::vector<uint32_t> decorations;
    size_t insertAt = code.size();
    forEachInstruction(code, [&](const Instruction& in, size_t at) {
        if (in.op == spv::Op::OpDecorate && in.size() == 3 && spv::Decoration(in[2]) == spv::Decoration::NoContraction)
            done.insert(in[1]);
        if (insertAt == code.size() && isDeclaration(in.op)) insertAt = at;
        if (!isFloatArithmetic(in.op) || in.size() < 3 || done.contains(in[2])) return;
        decorations.insert(decorations.end(),
                           {3u << 16 | uint32_t(spv::Op::OpDecorate), in[2], uint32_t(spv::Decoration::NoContraction)});
    });
    std::vector<uint32_t> out(code.begin(), code.begin() + ptrdiff_t(insertAt));
    out.insert(out.end(), decorations.begin(), decorations.end());
    out.insert(out.end(), code.begin() + ptrdiff_t(insertAt), code.end());
    return out;
}

std::vector<uint32_t> reconverged(std::span<const uint32_t> code) {
    constexpr std::string_view kExtension = "SPV_KHR_maximal_reconvergence";
    constexpr uint32_t kMaximallyReconverges = 6023;
    uint32_t entry = 0;
    bool shares = false, done = false;
    size_t behindCapabilities = kHeaderWords, behindEntry = kHeaderWords;
    forEachInstruction(code, [&](const Instruction& in, size_t at) {
        const size_t behind = at + in.size();
        if (in.op == spv::Op::OpCapability) {
            behindCapabilities = behind;
            shares = shares || (in.size() > 1 && in[1] >= uint32_t(spv::Capability::GroupNonUniform) &&
                                in[1] <= uint32_t(spv::Capability::GroupNonUniformQuad));
        }
        if (in.op == spv::Op::OpEntryPoint) entry = in[2], behindEntry = behind;
        if (in.op == spv::Op::OpExecutionMode) done = done || in[2] == kMaximallyReconverges;
    });
    if (!shares || done) return {code.begin(), code.end()};
    std::vector<uint32_t> extension(1 + kExtension.size() / 4 + 1);
    extension[0] = uint32_t(extension.size()) << 16 | uint32_t(spv::Op::OpExtension);
    std::memcpy(&extension[1], kExtension.data(), kExtension.size());
    std::vector<uint32_t> out(code.begin(), code.begin() + ptrdiff_t(behindCapabilities));
    out.insert(out.end(), extension.begin(), extension.end());
    out.insert(out.end(), code.begin() + ptrdiff_t(behindCapabilities), code.begin() + ptrdiff_t(behindEntry));
    out.insert(out.end(), {3u << 16 | uint32_t(spv::Op::OpExecutionMode), entry, kMaximallyReconverges});
    out.insert(out.end(), code.begin() + ptrdiff_t(behindEntry), code.end());
    return out;
}

}  // namespace espalier
