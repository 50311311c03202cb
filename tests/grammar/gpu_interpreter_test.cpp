// The interpreter on the device against the same text on the host, to the bit.
#include <algorithm>
#include <cstring>

#include "runtime/gpu/commands.hpp"
#include "runtime/gpu/device.hpp"
#include "tests/grammar/support.hpp"

using namespace grammar_test;

namespace {

constexpr uint32_t kRow = kRegisters + 2;

template <class T>
T must(Result<T> result) {
    if (!result) FAIL(result.failure().text());
    return std::move(*result);
}

void onHost(const RuleMapRef& map, uint32_t i, uint32_t words, uint32_t siteCount, float* row) {
    Machine machine;
    giveCase(MACHINE map, i, siteCount);
    runCode(MACHINE map.code, CodeRange{0, words});
    for (uint r = 0; r < kRegisters; ++r) row[r] = SLOT(r);
    row[kRegisters] = SLOT(kSlotAngle);
    row[kRegisters + 1] = SLOT(kSlotSlope);
}

// Quotients and remainders of anything and of whole numbers.
const char* const kDivision =
    "param p = 3 [1 .. 64]\n"
    "A(x, y, z, w) -> Marching(0.1, x / y + z / 7, x % y < w % p)\n"
    "    {A(floor(x * 900) % floor(y * 9), floor(x * 90) * floor(y * 9) / floor(y * 9), z % -0.3, w / p), NULL}\n";

struct InterpreterPush {
    uint64_t map, results;
    uint32_t count, words, siteCount, repeats;
};

}  // namespace

TEST_CASE("GPU and CPU interpret to the same bits") {
    DeviceOptions options;
    options.applicationName = "test_grammar";
    options.validation = true;
    Result<std::unique_ptr<Device>> created = Device::create(options);
    if (!created) {
        MESSAGE("skipped, no device: " << created.failure().text());
        return;
    }
    Device& device = **created;
    {
        Program program = must(Program::compute(device, "tests/interpreter.comp", {.exact = true, .constants = {}}));
        for (const char* name : {"ivy_free", "ivy_guided", "ivy_paper", ""}) {
            RuleMap map = *name ? must(compileGrammarFile(std::string("content/grammars/") + name + ".grammar"))
                                : compiled(kDivision);
            Buffer words = must(Buffer::create(device, "rule map", map.words().size() * 4));
            RuleMapRef ref = map.refAt(words.address());
            Buffer refs = must(Buffer::create(device, "rule map ref", sizeof ref));
            // The code lies between its own section and that of the sites.
            uint32_t codeWords = static_cast<uint32_t>(
                (reinterpret_cast<uint64_t>(ref.sites.v) - reinterpret_cast<uint64_t>(ref.code.v)) / 8);
            const uint32_t siteCount = std::min<uint32_t>(ref.siteCount, kMaxDraws);
            for (uint32_t count : {1u, 63u, 65u, 5000u}) {
                Buffer results = must(Buffer::create(device, "results", uint64_t(count) * kRow * 4));
                Commands commands = must(Commands::begin(device, "interpret"));
                REQUIRE(commands.upload(words, std::vector<uint32_t>(map.words().begin(), map.words().end())));
                REQUIRE(commands.upload(refs, std::vector<RuleMapRef>{ref}));
                commands.barrier(Use::transfer, Use::compute);
                {
                    Pass pass(commands, "interpret");
                    pass.dispatchItems(
                        program, count,
                        InterpreterPush{refs.address(), results.address(), count, codeWords, siteCount, 1});
                }
                REQUIRE(commands.finish());
                std::vector<float> got = must(readVector<float>(device, results, 0, count * kRow));
                uint32_t wrong = 0;
                for (uint32_t i = 0; i < count; ++i) {
                    float row[kRow];
                    onHost(map.ref(), i, codeWords, siteCount, row);
                    wrong += std::memcmp(row, &got[i * kRow], sizeof row) != 0 ? 1 : 0;
                }
                INFO(name << ", " << count);
                CHECK(wrong == 0);
            }
        }
    }
    CHECK(device.waitIdle());
    CHECK(device.validationMessages() == 0);
}
