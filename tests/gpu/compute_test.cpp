// Programs, dispatches, buffers: hostile input first, awkward sizes, exact arithmetic, shared layouts.
#include <cmath>
#include <cstring>
#include <random>

#include "runtime/gpu/spirv.hpp"
#include "shaders/emit/emit_records.h"
#include "shaders/shader_table.hpp"
#include "shaders/shared/exact.h"
#include "shaders/shared/growth_records.h"
#include "shaders/shared/rule_map.h"
#include "tests/gpu/gpu_test.hpp"

using namespace espalier;

TEST_CASE("broken SPIR-V is refused, wherever it ends and whatever it holds") {
    const std::span<const uint32_t> good = shaderCode("tests/exact.comp");
    REQUIRE(good.size() > 100);
    CHECK_FALSE(reflect("empty", {}));
    CHECK_FALSE(reflect("text", std::vector<uint32_t>(100, 0x20202020u)));
    CHECK(reflect("good", good));
    for (size_t length = 0; length < good.size(); ++length) (void)reflect("cut", good.first(length));
    std::mt19937 random(1);
    for (int i = 0; i < 3000; ++i) {
        std::vector<uint32_t> bad(good.begin(), good.end());
        for (int k = 0; k < 3; ++k) bad[random() % bad.size()] ^= 1u << (random() % 32);
        if (reflect("flipped", bad)) (void)withoutContraction(bad), (void)reconverged(bad);
    }
}

TEST_CASE("programs know their group size, push data and bindings") {
    TestDevice t;
    Program fill = must(Program::compute(t.device, "tests/fill.comp"));
    CHECK(fill.localSize() == std::array<uint32_t, 3>{64, 1, 1});
    CHECK(fill.pushBytes() == 20);
    CHECK(fill.slots().empty());
    Program bindings = must(Program::compute(t.device, "tests/bindings.comp"));
    CHECK(bindings.localSize() == std::array<uint32_t, 3>{8, 4, 1});
    REQUIRE(bindings.slots().size() == 3);
    CHECK(bindings.slots()[0].type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    CHECK(bindings.slots()[1].type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    CHECK(bindings.slots()[2].binding == 5);
    CHECK(bindings.slots()[2].type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    Program exact = must(Program::compute(t.device, "tests/exact.comp", {.exact = true, .constants = {{0, 32}}}));
    CHECK(exact.localSize() == std::array<uint32_t, 3>{32, 1, 1});
}

TEST_CASE("a kernel touches its items and nothing else, at awkward sizes") {
    TestDevice t;
    Program fill = must(Program::compute(t.device, "tests/fill.comp"));
    constexpr uint32_t kGuard = 0xABADCAFEu;
    for (uint32_t count : {0u, 1u, 63u, 64u, 65u, 1000u, 65535u * 64 + 65}) {
        Buffer words = must(Buffer::create(t.device, "words", (count + 1) * 4ull));
        Commands commands = must(Commands::begin(t.device, "fill"));
        commands.fill(words, kGuard);
        commands.barrier(Use::transfer, Use::compute);
        {
            Pass pass(commands, "fill");
            pass.dispatchItems(fill, count, FillPush{words.address(), count, 7});
        }
        REQUIRE(commands.finish());
        const std::vector<uint32_t> got = must(readVector<uint32_t>(t.device, words, 0, count + 1));
        bool right = got[count] == kGuard;
        for (uint32_t i = 0; i < count; ++i) right = right && got[i] == i * 7;
        CHECK_MESSAGE(right, count);
    }
    CHECK(t.device.milliseconds("fill") > 0);
}

TEST_CASE("indirect arguments that a transfer has written are seen") {
    TestDevice t;
    Program fill = must(Program::compute(t.device, "tests/fill.comp"));
    Buffer words = must(Buffer::create(t.device, "words", 130 * 4));
    Buffer arguments = must(Buffer::create(t.device, "arguments", 32));
    Commands commands = must(Commands::begin(t.device, "indirect"));
    commands.fill(words, 0);
    REQUIRE(commands.upload(arguments, std::vector<uint32_t>{0, 1, 1, 2, 1, 1}));
    commands.barrier(Use::transfer, Use::compute | Use::indirect);
    {
        Pass pass(commands, "indirect");
        pass.dispatchIndirect(fill, arguments, 0, FillPush{words.address(), 130, 5});
        pass.dispatchIndirect(fill, arguments, 12, FillPush{words.address(), 130, 1});
    }
    REQUIRE(commands.finish());
    const std::vector<uint32_t> got = must(readVector<uint32_t>(t.device, words, 0, 130));
    CHECK(got[127] == 127);  // two groups
    CHECK(got[128] == 0);
}

TEST_CASE("an exact program gives the bits of C++ without contraction") {
    TestDevice t;
    std::vector<vec3> triples;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> range(-2, 2);
    for (int i = 0; i < 100000; ++i) triples.push_back({range(random), range(random), range(random)});
    Program exact =
        must(Program::compute(t.device, "tests/exact.comp", {.exact = true, .constants = {{0, 64}, {1, 3}}}));
    Buffer in = must(makeBuffer(t.device, "triples", triples));
    Buffer out = must(Buffer::create(t.device, "results", triples.size() * 16));
    Commands commands = must(Commands::begin(t.device, "exact"));
    struct {
        uint64_t triples, results;
        uint32_t count;
    } push{in.address(), out.address(), uint32_t(triples.size())};
    Pass(commands, "exact").dispatchItems(exact, push.count, push);
    REQUIRE(commands.finish());
    const std::vector<vec4> got = must(readVector<vec4>(t.device, out, 0, triples.size()));
    size_t different = 0, fusedDiffers = 0;
    for (size_t i = 0; i < triples.size(); ++i) {
        const vec3 v = triples[i];
        float s, c;
        sinCosExact(v.x * 50.0f, s, c);
        const vec4 want(v.x * v.y + v.z, dot3(v, vec3(v.y, v.z, v.x)), rsqrtExact(absolute(v.x * v.y)), s * c + 3.0f);
        different += std::memcmp(&want, &got[i], sizeof want) != 0;
        fusedDiffers += std::fma(v.x, v.y, v.z) != want.x;
    }
    CHECK(different == 0);
    CHECK(fusedDiffers > 1000);  // the data can tell
}

TEST_CASE("every float operation of an exact module is decorated, once, and the module still stands") {
    const std::span<const uint32_t> code = shaderCode("tests/exact.comp");
    const std::vector<uint32_t> exact = withoutContraction(code);
    CHECK(exact.size() > code.size() + 3 * 20);
    CHECK((exact.size() - code.size()) % 3 == 0);
    CHECK(withoutContraction(exact) == exact);
    const Result<ShaderInterface> a = reflect("a", code), b = reflect("b", exact);
    REQUIRE((a && b));
    CHECK(a.value().pushBytes == b.value().pushBytes);
}

TEST_CASE("a module with operations of subgroups is told once to bring lanes together, others stay as they are") {
    const std::span<const uint32_t> code = shaderCode("expand/march.comp");
    const std::vector<uint32_t> together = reconverged(code);
    CHECK(together.size() == code.size() + 3 + 9);  // an execution mode, and an extension of 29 letters
    CHECK(reconverged(together) == together);
    const Result<ShaderInterface> a = reflect("a", code), b = reflect("b", together);
    REQUIRE((a && b));
    CHECK(a.value().slots == b.value().slots);
    CHECK(a.value().localSize == b.value().localSize);
    CHECK(withoutContraction(together).size() - together.size() == withoutContraction(code).size() - code.size());
    const std::span<const uint32_t> alone = shaderCode("expand/fit.comp");
    CHECK(reconverged(alone) == std::vector<uint32_t>(alone.begin(), alone.end()));
}

TEST_CASE("records have one layout in C++ and SPIR-V") {
    const ShaderInterface shader = must(reflect("layout", shaderCode("tests/layout.comp")));
    auto offset = [&](const std::string& record, std::string_view member) {
        auto found = shader.layouts.find(record);
        if (found == shader.layouts.end()) return -1;
        for (const auto& [name, bytes] : found->second)
            if (name == member) return int(bytes);
        return -2;
    };
    size_t records = 0, fields = 0, strides = 0;
    auto checkRecord = [&](const std::string& name, size_t size) {
        ++records;
        CHECK_MESSAGE(shader.layouts.contains(name), name << " must be named in shaders/tests/layout.comp");
        if (!shader.strides.contains(name)) return;
        ++strides;
        CHECK_MESSAGE(shader.strides.at(name) == size, name);
    };
#define RECORD(Name) checkRecord(#Name, sizeof(Name));
#define FIELD(Name, member) \
    ++fields;               \
    CHECK_MESSAGE(offset(#Name, #member) == int(offsetof(Name, member)), #Name "::" #member);
#include "record_layouts.inc"
    CHECK(records >= 20);
    CHECK(fields >= 100);
    CHECK(strides >= 12);
}
