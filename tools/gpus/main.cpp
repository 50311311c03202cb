// Compiles all compute kernels by Mesa's compiler for a GPU of AMD's, which needn't be there, and prints what they
// cost.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "shaders/shader_table.hpp"
#include "tools/command_line.hpp"
#include "tools/gpus/budgets.hpp"

using namespace espalier;

namespace {

constexpr int kNoDevice = 3;

int fail(const std::string& message, int code = 2) {
    std::fprintf(stderr, "espalier-gpus: %s\n", message.c_str());
    return code;
}

void printHead(const NullDevice& device) {
    std::printf("%s, %s\n%-36s %5s %5s %5s %7s %7s %9s %12s %7s\n", device.name().c_str(), device.driver().c_str(),
                "kernel", "lanes", "VGPRs", "SGPRs", "spilled", "scratch", "subgroups", "instructions", "bytes");
}

// True: within its budget.
bool printRow(std::string_view chip, std::string_view kernel, const KernelCost& cost) {
    const Budget budget = budgetOf(chip, kernel);
    const bool good = within(cost, budget);
    std::printf("%-36.*s %5u %5u %5u %7u %7u %9u %12u %7u", int(kernel.size()), kernel.data(), cost.lanes,
                cost.vectorRegisters, cost.scalarRegisters, cost.spilledVector + cost.spilledScalar, cost.scratchBytes,
                cost.subgroups, cost.instructions, cost.codeBytes);
    if (!good)
        std::printf("  BEYOND: at most %u spilled and %u bytes of scratch a lane, at least %u subgroups",
                    budget.spilled, budget.scratchBytes, budget.subgroups);
    std::printf("\n");
    return good;
}

int tell(const std::string& chip, const std::string& filter) {
    Result<NullDevice> device = NullDevice::open(chip);
    if (!device) return fail(device.failure().text(), kNoDevice);
    printHead(*device);
    uint32_t beyond = 0, kernels = 0;
    for (const Shader& shader : allShaders()) {
        if (!shader.name.ends_with(".comp") || shader.name.find(filter) == std::string_view::npos) continue;
        Result<KernelCost> cost = device->compile(shader.name, shader.code);
        if (!cost) return fail(cost.failure().text());
        kernels += 1;
        beyond += printRow(chip, shader.name, *cost) ? 0 : 1;
    }
    if (kernels == 0) return fail("no kernel's name contains \"" + filter + "\"");
    std::printf("%u of %u kernels are beyond their budget\n", beyond, kernels);
    return beyond == 0 ? 0 : 1;
}

int tellFile(const std::string& chip, const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    if (bytes.empty() || bytes.size() % 4 != 0) return fail(path + ": there is no SPIR-V in it");
    const std::span<const uint32_t> words(reinterpret_cast<const uint32_t*>(bytes.data()), bytes.size() / 4);
    Result<NullDevice> device = NullDevice::open(chip);
    if (!device) return fail(device.failure().text(), kNoDevice);
    printHead(*device);
    Result<KernelCost> cost = device->compile(path, words);
    if (!cost) return fail(cost.failure().text());
    return printRow(chip, path, *cost) ? 0 : 1;
}

int run(int argc, char** argv) {
    CLI::App app{
        "Compiles Espalier's compute kernels by Mesa's compiler for AMD's GPUs, without a GPU, and prints the "
        "registers, scratch memory and instructions that they take. Ends with 1 where a kernel is beyond its "
        "budget (tools/gpus/budgets.cpp), with 2 where it can't tell, with 3 where this Mesa doesn't know the chip."};
    std::string chip = "navi21", filter, module;
    app.add_option("--gpu", chip, "the chip, as Mesa calls it: navi21, polaris10, …")->capture_default_str();
    app.add_option("--filter", filter, "only kernels whose path contains this");
    app.add_option("--module", module, "a compiled module (SPIR-V) in place of Espalier's kernels");
    if (const auto ended = parseCommandLine(app, argc, argv)) return *ended;
    return module.empty() ? tell(chip, filter) : tellFile(chip, module);
}

}  // namespace

int main(int argc, char** argv) {
    return runProgram(
        "espalier-gpus", [&] { return run(argc, argv); }, 2);
}
