// In: a file of inputs. Out: one line on what the GPU grows of them, growing thrice in one process: by shaders from
// little room and from room that suffices, and, on a software device, as native code. Exits with 77 where there is no
// device.
#include <cstdio>

#include "runtime/expand/growth.hpp"
#include "runtime/gpu/buffer.hpp"
#include "tests/determinism/fixed_inputs.hpp"

namespace {

using namespace espalier;
using namespace espalier::determinismtest;

constexpr int kSkipped = 77;

std::string text(const GrowthStats& s) {
    char line[160];
    std::snprintf(line, sizeof line, "%016llx nodes %u branches %u leaves %u", static_cast<unsigned long long>(s.hash),
                  s.nodes, s.branches, s.leaves);
    return line;
}

Result<std::string> grown(Device& device, const GrowthInputs& inputs, const GrowthRoom& room) {
    Result<std::unique_ptr<Growth>> growth = Growth::create(device, room);
    if (!growth) return growth.failure();
    Status done = (*growth)->grow(inputs);
    if (!done) return done.failure();
    return text((*growth)->stats());
}

int run(Device& device, FixedInputs& in) {
    std::vector<Buffer> buffers;
    std::string trouble;
    auto upload = [&](const auto& values) -> uint64_t {
        if (values.empty()) return 0;
        auto made = makeBuffer(device, "inputs", values);
        if (!made) {
            trouble = made.failure().text();
            return 0;
        }
        buffers.push_back(std::move(*made));
        return buffers.back().address();
    };
    std::vector<SurfaceRef> surfaces{surfaceAt(in, upload)};
    std::vector<LayerRef> layers(kMaxLayers, LayerRef{{nullptr}, 0, 1});
    std::vector<RuleMapRef> grammars;
    for (FixedGrammar& g : in.grammars) grammars.push_back(grammarAt(g, upload(g.words)));
    GrowthInputs inputs;
    inputs.surfaces = {reinterpret_cast<SurfaceRef*>(upload(surfaces))};
    inputs.surfaceCount = 1;
    inputs.layers = {reinterpret_cast<LayerRef*>(upload(layers))};
    inputs.grammars = grammars;
    inputs.seeds = in.seeds;
    inputs.limits.maxNodes = kMostNodes;
    GrowthRoom little{64, 512, 64, 512, 64};
    inputs.native = false;
    Result<std::string> tight = grown(device, inputs, little);
    Result<std::string> wide = grown(device, inputs, {});
    inputs.native = true;
    Result<std::string> native = grown(device, inputs, {});
    for (const auto* result : {&tight, &wide, &native}) {
        if (trouble.empty() && *result) continue;
        std::fprintf(stderr, "%s\n", (!trouble.empty() ? trouble : result->failure().text()).c_str());
        return 1;
    }
    if (*tight != *wide || *native != *wide) {
        std::fprintf(stderr, "little room: %s\nenough room: %s\nnative code: %s\n", tight->c_str(), wide->c_str(),
                     native->c_str());
        return 1;
    }
    std::puts(wide->c_str());
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    FixedInputs in;
    if (argc != 2 || !readInputs(in, argv[1])) {
        std::fprintf(stderr, "usage: %s INPUTS\n", argv[0]);
        return 1;
    }
    DeviceOptions options;
    options.applicationName = "determinism";
    Result<std::unique_ptr<Device>> device = Device::create(options);
    if (!device) {
        std::printf("no device: %s\n", device.failure().text().c_str());
        return kSkipped;
    }
    return run(**device, in);
}
